// SPDX-License-Identifier: Apache-2.0
//
// What the page shows. Options may stand in its address: ?api=webgpu&level=quick&checks=tilings,model-*&seed=1&power=low-power, and
// run=1 starts at once; scene=TEXT, or the name of a case of the corpus, is that scene alone.
const element = (id) => document.getElementById(id);
const form = element("form"), options = new URLSearchParams(location.search);
const kOptions = ["api", "level", "power", "seed", "checks"];
const kSaidEvery = 20000;  // milliseconds between what a screen reader is told of progress
let worker = null, told = {}, lines = [];

for (const name of kOptions) if (options.has(name)) form.elements[name].value = options.get(name);

// A button that waits keeps the focus: for who uses the keyboard, none is disabled.
function wait(waits) {
  for (const id of ["start", "draw"]) element(id).setAttribute("aria-disabled", waits);
}

function show(id, text) {
  element(id).textContent = text;
}

function duration(seconds) {
  return seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.ceil(seconds / 60)} min`;
}

// A run is as long as the first part of it says; nothing is said of it before there is one.
function progressText(start, [check, checks, share]) {
  const seconds = (performance.now() - start) / 1000;
  const left = share > 0.02 ? `, about ${duration((seconds / share) * (1 - share))} left` : "";
  return `Check ${check + 1} of ${checks}, ${Math.floor(100 * share)} %${left}`;
}

function download(name, text, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

async function copy(text) {
  await navigator.clipboard.writeText(text);
  show("copied", "Copied.");
}

// The verdict in a sentence, and what is said beside it.
export function sentences(certificate) {
  const { checks, rival, verdict } = certificate;
  const failed = checks.filter((check) => check.failed > 0).length;
  const judged = checks.filter((check) => check.done > check.skipped && check.samples > 0).length;
  const samples = checks.reduce((sum, check) => sum + check.samples, 0).toLocaleString("en");
  const found = `By probing: ${rival.inferred_model}.`;
  if (verdict === "certified") {
    return ["good", `${rival.name} is certified: ${judged} checks, ${samples} samples, no difference.`, found];
  }
  if (verdict === "incomplete") return ["open", `Stopped: no difference in what was looked at of ${rival.name}.`, found];
  // What ended the probing comes before what faults are like.
  const ended = rival.problems.find((problem) => problem.startsWith("when probed"));
  const cause = ended ?? rival.names[0] ?? rival.problems[0] ?? certificate.stopped;
  return ["bad", `${rival.name} is not certified: ${failed} of ${checks.length} checks found a difference.`,
    cause ? `${ended ? "It fails" : "Likely"}: ${cause.replace(/\.$/, "")}. ${found}` : found];
}

function issueText(certificate) {
  const [, verdict, detail] = sentences(certificate);
  return `${verdict}\n${detail}\n\n${navigator.userAgent}\n\n\`\`\`\n${lines.filter((line) => !/^(ok|n\/a) /.test(line)).join("")}\`\`\`\n`;
}

// The command's report without its head, and a button beside each scene.
function showReport(html) {
  const main = new DOMParser().parseFromString(html, "text/html").querySelector("main");
  main.querySelectorAll("h1, h1 + .sub").forEach((part) => part.remove());
  main.querySelectorAll("summary").forEach((summary) => {
    if (summary.textContent !== "The scene") return;
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = "Copy the scene";
    const link = document.createElement("a");
    link.textContent = "Draw it alone";
    link.href = `?${new URLSearchParams({ api: form.elements.api.value, scene: summary.parentElement.querySelector("pre").textContent, run: 1 })}`;
    summary.parentElement.append(button, " ", link);
  });
  main.querySelectorAll("svg").forEach((picture) => {
    picture.setAttribute("role", "img");
    picture.setAttribute("aria-label", picture.closest("figure")?.querySelector("figcaption")?.textContent ?? "Where edges turn, as a picture");
  });
  main.querySelectorAll("th:empty").forEach((head) => head.replaceWith(document.createElement("td")));
  // What scrolls sideways is reached by keyboard, too, and each such region has a name of its own.
  const names = new Map();
  let heading = "";
  main.querySelectorAll("h2, h3, summary, pre, .wide").forEach((part) => {
    if (!part.matches("pre, .wide")) return (heading = part.textContent);
    part.tabIndex = 0;
    if (part.matches("pre")) return;
    names.set(heading, (names.get(heading) ?? 0) + 1);
    part.setAttribute("role", "region");
    part.setAttribute("aria-label", names.get(heading) > 1 ? `${heading}, ${names.get(heading)}` : heading);
  });
  element("report").replaceChildren(...main.children);
}

// Of one scene.
export function sceneSentences({ rival, model, applies, samples, open, differences, finding }) {
  const judged = `${samples} sample${samples === 1 ? "" : "s"} judged, ${open} open`;
  if (!applies && !differences) return ["open", `${rival} owes nothing on this scene: it lacks something, or its model leaves all of it open.`, model];
  if (!differences) return ["good", `${rival} draws this scene as its model says: ${judged}.`, `By probing: ${model}.`];
  return ["bad", `${rival} draws this scene wrongly: ${finding}.`, `${differences} differences, ${judged}. By probing: ${model}.`];
}

function showOutcome(state, verdict, detail) {
  element("outcome").hidden = false;
  element("verdict").className = state;
  show("verdict", verdict);
  show("detail", detail);
  const whole = Boolean(told.certificate);
  for (const id of ["save", "copy", "save-report"]) element(id).hidden = !whole;
  if (whole) showReport(told.report);
  else element("report").innerHTML = told.report ?? "";
  document.documentElement.dataset.state = "done";  // for who drives the page
  element("verdict").focus();
}

function finish(cost) {
  worker.terminate();
  worker = null;
  element("running").hidden = element("stop").hidden = true;
  wait(false);
  show("said", "");
  if (cost.failed) return showOutcome("bad", "The page itself went wrong.", cost.failed);
  show("cost", `${cost.seconds.toFixed(1)} s, of which the GPU and its driver ${cost.waited.toFixed(1)} s for ${cost.drawn} scenes; ` +
    `${Math.round(cost.bytes / 1024)} KB of judge and corpus were loaded.`);
  document.documentElement.dataset.cost = JSON.stringify(cost);
  if (told.unopened) return showOutcome("open", "Nobody was judged.", told.unopened);
  if (told.error) return showOutcome("bad", "The judge itself went wrong.", told.error);
  showOutcome(...(told.verdict ? sceneSentences(JSON.parse(told.verdict)) : sentences(JSON.parse(told.certificate))));
}

// Certifies, or draws the scene, if there is one.
function start(scene = "") {
  const chosen = Object.fromEntries(kOptions.map((name) => [name, form.elements[name].value.trim()]));
  chosen.scene = scene.trim() && `${scene.trimEnd()}\n`;
  chosen.wrong = options.get("wrong") ?? "";  // a planted fault, for tests
  chosen.seed ||= "1";
  told = {};
  lines = [];
  element("outcome").hidden = true;
  element("running").hidden = element("stop").hidden = false;
  wait(true);
  element("progress").removeAttribute("value");
  for (const id of ["state", "said"]) show(id, "Finding out by which rules it draws …");
  document.documentElement.dataset.state = "running";
  const begin = performance.now();
  let shown = 0, said = begin;
  worker = new Worker(new URL("worker.mjs", import.meta.url), { type: "module" });
  worker.onerror = (event) => finish({ failed: event.message || "the worker did not start" });
  worker.onmessage = ({ data }) => {
    if (data.told) {
      told[data.told[0]] = data.told[1];
      if (data.told[0] === "line") lines.push(data.told[1]);
      if (data.told[0] === "scene") element("scene").value = data.told[1];
    }
    if (data.progress) {
      element("progress").value = data.progress[2];
      const now = performance.now(), text = progressText(begin, data.progress);
      if (now - shown > 1000) show("state", text), (shown = now);
      if (now - said > kSaidEvery) show("said", text), (said = now);
    }
    if (data.done || data.failed) finish(data.done ?? data);
  };
  worker.postMessage({ run: chosen });
}

form.addEventListener("submit", (event) => {
  event.preventDefault();
  if (!worker) start();
});
element("scene-form").addEventListener("submit", (event) => {
  event.preventDefault();
  const scene = element("scene").value;
  if (worker || !scene.trim()) return;
  history.replaceState(null, "", `?${new URLSearchParams({ api: form.elements.api.value, scene })}`);
  start(scene);
});
element("example").addEventListener("change", (event) => (element("scene").value = event.target.value));
element("stop").addEventListener("click", () => {
  worker?.postMessage({ stop: true });
  for (const id of ["state", "said"]) show(id, "Stopping …");
});
element("save").addEventListener("click", () => download("surefill-certificate.json", told.certificate, "application/json"));
element("save-report").addEventListener("click", () => download("surefill-report.html", told.report, "text/html"));
element("copy").addEventListener("click", () => copy(issueText(JSON.parse(told.certificate))));
element("report").addEventListener("click", (event) => {
  if (event.target.textContent === "Copy the scene") copy(event.target.parentElement.querySelector("pre").textContent);
});

if (options.has("scene")) {
  element("one").open = true;
  element("scene").value = options.get("scene");
}
if (options.get("run") === "1") start(options.get("scene") ?? "");
