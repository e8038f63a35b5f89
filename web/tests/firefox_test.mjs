#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// The page in Firefox: runs from the button to the certificate, planted faults, pictures of it. WebGL2 is Mesa's llvmpipe; WebGPU is
// Chromium's software driver, so that the command's certificate is one of the same (same_test.mjs), or another Vulkan driver:
//
//   node web/tests/firefox_test.mjs [--api webgl2|webgpu] [--vulkan /usr/share/vulkan/icd.d/lvp_icd.x86_64.json] [--folder build/web]
//     [--tools build/web-tools] [--out build/web-page]
//
// Firefox has WebGL2 where it has a display: Xvfb is one. It is driven by WebDriver BiDi, as it comes (npm's puppeteer-core).
import { spawn } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { parseArgs } from "node:util";
import { fileURLToPath } from "node:url";
import { kSwiftShader } from "../dawn.mjs";
import { serveFolder } from "../folder_server.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const { values } = parseArgs({
  options: {
    api: { type: "string" },  // both
    vulkan: { type: "string", default: kSwiftShader },
    folder: { type: "string", default: join(root, "build/web") },
    tools: { type: "string", default: join(root, "build/web-tools") },
    out: { type: "string", default: join(root, "build/web-page") },
    browser: { type: "string", default: "/usr/bin/firefox-esr" },
  },
});
const kMinutes = 60 * 1000;
const kWrongStates = ["viewport", "scissor", "cull", "front-face", "depth-range", "depth-test", "flipped-y"];
// Software drivers are on Firefox's list of those that it does not use by itself.
const kPreferences = {
  "webgl.force-enabled": true, "dom.webgpu.enabled": true, "dom.webgpu.workers.enabled": true, "gfx.webgpu.ignore-blocklist": true,
};

// A display that nobody sees: its process and its name.
async function openDisplay() {
  const server = spawn("Xvfb", ["-displayfd", "1", "-screen", "0", "1400x1100x24", "-nolisten", "tcp"], { stdio: ["ignore", "pipe", "ignore"] });
  const number = await new Promise((ready, failed) => {
    server.on("error", failed);
    server.on("exit", (status) => failed(new Error(`Xvfb ended with status ${status}`)));
    server.stdout.on("data", (text) => ready(String(text).trim()));
  });
  return { server, name: `:${number}` };
}

async function openFirefox(display, downloads) {
  const puppeteer = createRequire(join(values.tools, "/"))("puppeteer-core");
  return puppeteer.launch({
    browser: "firefox", executablePath: values.browser, headless: false, timeout: 5 * kMinutes, protocolTimeout: 30 * kMinutes,
    env: { ...process.env, DISPLAY: display, LIBGL_ALWAYS_SOFTWARE: "1", VK_ICD_FILENAMES: values.vulkan },
    extraPrefsFirefox: { ...kPreferences, "browser.download.folderList": 2, "browser.download.dir": downloads },
  });
}

await mkdir(values.out, { recursive: true });
const downloads = await mkdtemp(join(tmpdir(), "surefill-"));
const server = await serveFolder(values.folder);
const display = await openDisplay();
let browser, failures = 0;

function expect(holds, what) {
  console.log(`${holds ? "ok  " : "FAIL"}  ${what}`);
  if (!holds) ++failures;
}

// What the button saves.
async function saved(page) {
  const path = join(downloads, "surefill-certificate.json");
  await page.click("#save");
  for (let tries = 0; tries < 100; ++tries) {
    const text = await readFile(path, "utf8").catch(() => "");
    if (text.endsWith("}\n") || text.endsWith("}")) {
      await rm(path);
      return text;
    }
    await sleep(100);
  }
  throw new Error("no certificate was saved within 10 s");
}

// A page that ran with these options to its end: what it says, its certificate.
async function ran(options) {
  const page = await browser.newPage();
  await page.setViewport({ width: 1200, height: 900 });
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.goto(`${server.address}/index.html?${new URLSearchParams({ ...options, run: 1 })}`);
  await page.waitForFunction(() => document.documentElement.dataset.state === "done", { timeout: 20 * kMinutes, polling: 250 });
  const said = await page.evaluate(() => ({
    verdict: document.getElementById("verdict").textContent, detail: document.getElementById("detail").textContent,
    focus: document.activeElement.id, cost: JSON.parse(document.documentElement.dataset.cost ?? "null"),
    saves: !document.getElementById("save").hidden,
  }));
  const text = said.saves ? await saved(page) : "null";
  return { page, ...said, text, certificate: JSON.parse(text), errors };
}

const fits = (page) => page.evaluate(() => document.documentElement.scrollWidth <= innerWidth);

async function testWhole(api, name, model) {
  const whole = await ran({ api, level: "quick" });
  const { page, verdict, certificate } = whole;
  expect(whole.errors.length === 0, `${api}: no errors on the page${whole.errors.length ? `: ${whole.errors.join("; ")}` : ""}`);
  expect(certificate?.format === "surefill-certificate", `${api}: a certificate is saved`);
  expect(name.test(verdict), `${api}: verdict: ${verdict} ${whole.detail}`);
  expect(model.test(certificate?.rival.inferred_model), `${api}: model: ${certificate?.rival.inferred_model}`);
  expect(whole.focus === "verdict", `${api}: the verdict has the focus`);
  expect(await page.evaluate(() => document.querySelectorAll("#report table").length > 0), `${api}: the checks are shown`);
  for (const width of [1200, 420]) {
    await page.setViewport({ width, height: 900 });
    expect(await fits(page), `${api}: the page is as wide as the window, at ${width} px`);
    await page.screenshot({ path: join(values.out, `firefox-${api}-${width}.png`), fullPage: true });
  }
  await writeFile(join(values.out, `firefox-${api}.json`), whole.text);
  const { seconds, waited, drawn } = whole.cost;
  console.log(`      ${seconds.toFixed(1)} s, of which the GPU and its driver ${waited.toFixed(1)} s for ${drawn} scenes`);
  await page.close();
}

async function testFaults(api) {
  // States that are set wrongly: nobody is blamed.
  for (const wrong of kWrongStates) {
    const { page, verdict, detail, certificate } = await ran({ api, wrong, checks: "model" });
    expect(verdict === "Nobody was judged." && certificate === null && /^self-check/.test(detail), `${api}, ${wrong}: ${detail}`);
    await page.close();
  }
  // A fault of the driver's kind: found, and named.
  const { page, certificate } = await ran({ api, wrong: "sample-moved", checks: "model,tilings" });
  const model = certificate?.rival.inferred_model;
  expect(/samples at \(0\.4375, 0\.5\)/.test(model), `${api}, sample-moved: ${model}`);
  await page.close();
}

try {
  browser = await openFirefox(display.name, downloads);
  console.log(`      ${await browser.version()}`);
  const has = (api) => !values.api || values.api === api;
  if (has("webgl2")) {
    await testFaults("webgl2");
    await testWhole("webgl2", /^WebGL2 on llvmpipe.* is (not )?certified/, /grid of 8 bits.*rows from the bottom/);
  }
  if (has("webgpu")) {
    await testFaults("webgpu");
    await testWhole("webgpu", /^WebGPU on .* is (not )?certified/, /grid of [48] bits.*rows from the top/);
  }
} finally {
  await browser?.close();
  display.server.removeAllListeners("exit");
  display.server.kill();
  server.close();
  await rm(downloads, { recursive: true });
}
process.exit(failures ? 1 : 0);
