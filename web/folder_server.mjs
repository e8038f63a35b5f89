#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// A folder on loopback, as any static host serves it:
//
//   node web/folder_server.mjs [FOLDER] [PORT]
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";
import { pathToFileURL } from "node:url";

const kTypes = {
  ".css": "text/css", ".gz": "application/gzip", ".html": "text/html; charset=utf-8", ".json": "application/json", ".mjs": "text/javascript",
};

// Port 0: any that is free.
export async function serveFolder(folder, port = 0) {
  const server = createServer(async (request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname));
    try {
      const content = await readFile(join(folder, path === "/" ? "index.html" : path));
      response.writeHead(200, { "content-type": kTypes[extname(path)] ?? "text/html; charset=utf-8" }).end(content);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((ready) => server.listen(port, "127.0.0.1", ready));
  return { address: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const { address } = await serveFolder(process.argv[2] ?? "build/web", Number(process.argv[3] ?? 8000));
  console.log(address);
}
