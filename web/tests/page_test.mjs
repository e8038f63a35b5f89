#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
//
// The page in headless Chromium, on its software driver: a run from the button to the certificate, planted faults, pictures of it.
//
//   node web/tests/page_test.mjs [--folder build/web] [--tools build/web-tools] [--out build/web-page]
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { parseArgs } from "node:util";
import { fileURLToPath } from "node:url";
import { serveFolder } from "../folder_server.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const { values } = parseArgs({
  options: {
    folder: { type: "string", default: join(root, "build/web") },
    tools: { type: "string", default: join(root, "build/web-tools") },
    out: { type: "string", default: join(root, "build/web-page") },
    browser: { type: "string", default: "/usr/bin/chromium-headless-shell" },
  },
});
const { chromium } = createRequire(join(values.tools, "/"))("playwright-core");
await mkdir(values.out, { recursive: true });
const server = await serveFolder(values.folder);
const browser = await chromium.launch({ executablePath: values.browser, args: ["--enable-unsafe-webgpu"] });
let failures = 0;

function expect(holds, what) {
  console.log(`${holds ? "ok  " : "FAIL"}  ${what}`);
  if (!holds) ++failures;
}

// A page that ran with these options to its end: what it says, its certificate.
async function ran(options, { width = 1200, scheme = "light", seconds = 600 } = {}) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme: scheme, acceptDownloads: true });
  const page = await context.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.goto(`${server.address}/index.html?${new URLSearchParams({ ...options, run: 1 })}`);
  await page.waitForFunction(() => document.documentElement.dataset.state === "done", null, { timeout: 1000 * seconds });
  const verdict = await page.textContent("#verdict"), detail = await page.textContent("#detail");
  const focus = await page.evaluate(() => document.activeElement.id);
  let text = "null";
  if (await page.isVisible("#save")) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
    text = await readFile(await download.path(), "utf8");
  }
  const cost = JSON.parse((await page.getAttribute("html", "data-cost")) ?? "null");
  return { page, context, verdict, detail, focus, text, certificate: JSON.parse(text), cost, errors };
}

// What axe-core (npm) finds against accessibility.
const axe = await readFile(createRequire(join(values.tools, "/")).resolve("axe-core/axe.min.js"), "utf8");
async function accessible(page, what) {
  await page.evaluate(axe);
  const found = await page.evaluate(async () => (await globalThis.axe.run(document)).violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`));
  expect(found.length === 0, `accessible, ${what}${found.length ? `: ${found.join("; ").slice(0, 600)}` : ""}`);
}

const fits = (page) => page.evaluate(() => document.documentElement.scrollWidth <= innerWidth);

try {
  // The whole of it.
  const whole = await ran({ level: "quick" });
  expect(whole.errors.length === 0, `no errors on the page${whole.errors.length ? `: ${whole.errors.join("; ")}` : ""}`);
  expect(whole.certificate?.format === "surefill-certificate", "a certificate is saved");
  expect(/is (not )?certified/.test(whole.verdict), `verdict: ${whole.verdict}`);
  expect(/grid of 4 bits/.test(whole.certificate?.rival.inferred_model), `model: ${whole.certificate?.rival.inferred_model}`);
  expect(await fits(whole.page), "the page is as wide as the window, at 1200 px");
  expect((await whole.page.locator("#report svg").count()) > 1, "there are pictures");
  expect(whole.focus === "verdict", "the verdict has the focus");
  await accessible(whole.page, "a verdict at 1200 px");
  await whole.page.screenshot({ path: join(values.out, "page-1200.png"), fullPage: true });
  await whole.page.setViewportSize({ width: 420, height: 900 });
  expect(await fits(whole.page), "the page is as wide as the window, at 420 px");
  await whole.page.screenshot({ path: join(values.out, "page-420.png"), fullPage: true });
  await whole.page.emulateMedia({ colorScheme: "dark" });
  await whole.page.screenshot({ path: join(values.out, "page-420-dark.png") });
  await whole.page.evaluate(() => document.querySelectorAll("details").forEach((part) => (part.open = true)));
  await accessible(whole.page, "a verdict at 420 px, dark, all open");
  await writeFile(join(values.out, "chromium-webgpu.json"), whole.text);
  const { seconds, waited, drawn, bytes } = whole.cost;
  console.log(`      ${seconds.toFixed(1)} s, of which the GPU and its driver ${waited.toFixed(1)} s for ${drawn} scenes; ${bytes} bytes`);
  await whole.context.close();

  // WebGL2 as a whole: the same driver, so the same grid; its rows go up.
  const other = await ran({ api: "webgl2", level: "quick" }, { scheme: "dark" });
  expect(/^WebGL2 on .* is (not )?certified/.test(other.verdict), `verdict: ${other.verdict}`);
  expect(/grid of 4 bits.*rows from the bottom/.test(other.certificate?.rival.inferred_model), `model: ${other.certificate?.rival.inferred_model}`);
  expect(other.errors.length === 0, `no errors on the page${other.errors.length ? `: ${other.errors.join("; ")}` : ""}`);
  await other.page.screenshot({ path: join(values.out, "webgl2-1200-dark.png"), fullPage: true });
  await writeFile(join(values.out, "chromium-webgl2.json"), other.text);
  await other.context.close();

  for (const api of ["webgpu", "webgl2"]) {
    // States that are set wrongly: nobody is blamed.
    for (const wrong of ["viewport", "scissor", "cull", "front-face", "depth-range", "depth-test", "flipped-y"]) {
      const { context, verdict, detail, certificate } = await ran({ api, wrong, checks: "model" });
      expect(verdict === "Nobody was judged." && certificate === null, `${api}, ${wrong}: ${detail}`);
      await context.close();
    }
    // A fault of the driver's kind: found, and named.
    const moved = await ran({ api, wrong: "sample-moved", checks: "model,tilings" });
    const model = moved.certificate?.rival.inferred_model;
    expect(/samples at \(0\.4375, 0\.5\)/.test(model), `${api}, sample-moved: ${model}`);
    await moved.context.close();
  }

  // A device that is lost again and again is a finding, and the page goes on with new ones until it gives up.
  const lost = await ran({ wrong: "lost-device", checks: "model,small-world-*" });
  expect(/is not certified/.test(lost.verdict) && /the device was lost/.test(lost.detail), `lost-device: ${lost.verdict} ${lost.detail}`);
  await lost.context.close();

  // One scene, by its name in the corpus and as text; and no scene.
  const scene = await ran({ scene: "cracks/drtk-9-diagonal-hole" });
  expect(/draws this scene as its model says: 57 samples judged, 7 open/.test(scene.verdict), `a scene: ${scene.verdict}`);
  expect((await scene.page.locator("#report figure").count()) >= 2, "engine and GPU are shown");
  await scene.page.screenshot({ path: join(values.out, "scene-1200.png"), fullPage: true });
  await scene.context.close();
  const text = whole.certificate.checks.find((check) => check.name === "clear-samples").scene_text;
  const found = await ran({ scene: text });
  expect(/draws this scene wrongly: count at pixel/.test(found.verdict), `a finding's scene: ${found.verdict}`);
  await found.context.close();
  const none = await ran({ scene: "surefill-scene 1" });
  expect(none.verdict === "Nobody was judged.", `no scene: ${none.detail}`);
  await none.context.close();

  // By keyboard alone.
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.goto(`${server.address}/index.html`);
  await page.keyboard.press("Tab");
  expect((await page.evaluate(() => document.activeElement.id)) === "start", "the first stop of the keyboard is the button");
  await accessible(page, "at the start");
  await page.keyboard.press("Enter");
  await accessible(page, "while it runs");
  await page.keyboard.press("Tab");
  expect((await page.evaluate(() => document.activeElement.id)) === "stop", "the next stop of the keyboard, while it runs, is the one to end it");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.documentElement.dataset.state === "done", null, { timeout: 120000 });
  const stopped = await page.textContent("#verdict");
  expect(/^Stopped/.test(stopped), `it is started and ended by keyboard: ${stopped}`);
  await context.close();
} finally {
  await browser.close();
  server.close();
}
process.exit(failures ? 1 : 0);
