const element = (id) => document.getElementById(id);
const CAP = 1000; // Ohm: what is above is not drawn
const THRESHOLD = START["chatter.resistanceThreshold"];
// In strides, so that the curve shows early.
const FREQUENCIES = Array.from({ length: 41 }, (_, n) => Number((50 * 100 ** (n / 40)).toPrecision(4)));
const ORDER = [8, 4, 2, 1].flatMap((stride, round) => FREQUENCIES.filter((_, n) => n % stride === 0 && (round === 0 || n % (2 * stride) !== 0)));
let values = valuesOf(location.hash);
let run = null;
let levels = new Map();
let broken = ""; // what ended the search for levels

// ---- workers ----
const packed = Uint8Array.from(atob(element("library").textContent), (letter) => letter.charCodeAt(0));
const script = URL.createObjectURL(new Blob([element("worker").textContent], { type: "text/javascript" }));

function worker(receive) {
  const made = new Worker(script);
  made.onmessage = ({ data }) => receive(data);
  made.onerror = () => receive({ error: "The computation failed." });
  made.postMessage({ library: packed });
  return made;
}

let loaded = false;
let busy = true;
let waiting = null;
const curves = worker((data) => {
  loaded ||= Boolean(data.ready);
  // Where the library cannot be loaded nothing is sent to it: the error says why.
  busy = !loaded;
  if (!data.ready) {
    run = data.error ? { error: data.error } : read(data);
    draw();
  }
  if (waiting !== null) send(waiting);
});

function send(scene) {
  if (busy) {
    waiting = scene;
    return;
  }
  waiting = null;
  busy = true;
  curves.postMessage({ scene });
}

let searching = null;
let later = 0;
function search() {
  if (searching) {
    searching.terminate();
    searching.onmessage = null; // what it has sent is of other values
  }
  clearTimeout(later);
  [levels, broken] = [new Map(), ""];
  later = setTimeout(() => {
    searching = worker((data) => {
      if (data.ready) searching.postMessage({ scene: sceneOf(values), frequencies: ORDER });
      else if (data.error) broken = ` Ended: ${data.error}`;
      else levels.set(data.frequency, data);
      drawLevels();
    });
  }, 300);
}

// ---- what the library gives: the order is that of `curves` ----
function read({ numbers, taken }) {
  const [count, rows, events, preload, frequency, longest, total, forceError] = numbers;
  const column = (n) => Float64Array.from({ length: rows }, (_, row) => numbers[8 + 5 * row + n]);
  const [time, force, least, most, highest] = [0, 1, 2, 3, 4].map(column);
  const end = time[rows - 1];
  const open = [];
  for (let n = 0; n < events; n++) {
    const [instant, opens] = numbers.slice(8 + 5 * rows + 2 * n);
    if (opens) open.push([instant, end]);
    else if (open.length) open[open.length - 1][1] = instant;
  }
  return { count, preload, frequency, longest, total, forceError, time, force, least, most, highest, open, taken };
}

// ---- drawing ----
const digits = (value, n = 3) => Number(value.toPrecision(n)).toString();

function draw() {
  const state = element("state");
  state.classList.toggle("wrong", Boolean(run.error));
  if (run.error) {
    state.textContent = run.error;
    return;
  }
  const { time, force, least, most, highest, open, preload } = run;
  const ms = time.map((value) => 1e3 * value);
  const bands = open.map((band) => band.map((value) => 1e3 * value));
  const x = { low: 0, high: ms[ms.length - 1], label: "time, ms" };
  const top = most.reduce((a, b) => Math.max(a, b), preload);
  const bottom = least.reduce((a, b) => Math.min(a, b));
  const interruptions = run.count === 0 ? "no interruption"
    : `${run.count} interruption${run.count > 1 ? "s" : ""}, the longest ${digits(1e6 * run.longest)} µs`;
  state.textContent = `${open.length ? `opens ${open.length} time${open.length > 1 ? "s" : ""}` : "stays closed"}; ${interruptions}`;
  // Blows as the contact closes again would press everything else flat.
  const usual = Float64Array.from(most).sort()[Math.floor(0.95 * most.length)];
  const shown = Math.min(1.08 * top, Math.max(1.3 * usual, 1.3 * preload));
  plot(element("force"), {
    x, y: { low: 0, high: shown, label: "contact force, N" }, bands,
    curves: [{ x: ms, y: least, to: most }, { x: ms, y: force }], marks: [{ y: preload, text: "preload" }],
  });
  element("force-caption").textContent = `Contact force: ${digits(bottom)} to ${digits(top)} N, ${digits(preload)} N at rest. `
    + `${top > shown ? "Higher peaks are cut off. " : ""}First natural frequency ${digits(run.frequency, 4)} Hz. ${open.length ? "Shaded: open. " : ""}Computed in ${run.taken.toFixed(0)} ms, estimated error of the force ${digits(100 * run.forceError, 1)} %.`;
  const worst = highest.reduce((a, b) => Math.max(a, b));
  const best = highest.reduce((a, b) => Math.min(a, b));
  const low = 10 ** Math.floor(Math.log10(best) - 0.1);
  const high = Math.min(CAP, Math.max(10 ** Math.ceil(Math.log10(worst) + 0.1), 10 * low));
  plot(element("resistance"), {
    x, y: { low, high, log: true, label: "contact resistance, Ω" }, bands, curves: [{ x: ms, y: highest }],
    marks: THRESHOLD < high ? [{ y: THRESHOLD, text: `${THRESHOLD} Ω: interrupted` }] : [],
  });
  element("resistance-caption").textContent = `Highest contact resistance in each of ${highest.length - 1} steps: ${digits(1e3 * best)} mΩ to `
    + `${worst > CAP ? "open" : `${digits(1e3 * worst)} mΩ`}. Interrupted from ${THRESHOLD} Ω on for 10 µs: ${interruptions}.`;
  drawLevels();
}

function drawLevels() {
  const found = [...levels.values()].sort((a, b) => a.frequency - b.frequency);
  const opening = found.filter(({ level }) => Number.isFinite(level));
  const sine = values["effects.excitation"] === "Sine";
  const now = Math.abs(values["excitation.amplitude"]) / G;
  const shown = found.flatMap(({ level, linear }) => [level, linear]).filter(Number.isFinite).map((value) => value / G);
  const here = sine && now >= 0.1 ? [now] : [];
  const low = Math.min(10, ...shown, ...here);
  const high = Math.max(100, ...shown, ...here);
  plot(element("level"), {
    x: { low: FREQUENCIES[0], high: FREQUENCIES[FREQUENCIES.length - 1], log: true, label: "frequency, Hz" },
    y: { low: 0.8 * low, high: Math.min(1.25 * high, 1e5), log: true, label: "acceleration that opens the contact, g" },
    curves: [
      { x: found.map((each) => each.frequency), y: found.map((each) => each.linear / G), kind: "mark" },
      { x: opening.map((each) => each.frequency), y: opening.map((each) => each.level / G) },
    ],
    here: here.length ? [values["excitation.frequency"], now] : undefined,
  });
  element("progress").value = levels.size / FREQUENCIES.length;
  const least = opening.reduce((a, b) => (a && a.level <= b.level ? a : b), null);
  element("level-caption").textContent = "Steady sine from which on the contact opens; dashed: linear theory"
    + (here.length ? "; dot: this vibration. " : ". ")
    + (least ? `Least so far: ${digits(least.level / G)} g at ${digits(least.frequency, 4)} Hz.` : "") + broken;
}

// ---- controls ----
const rows = new Map();

function add(control) {
  const group = element("controls").querySelector(`[name="${control.group}"]`) ?? element("controls").appendChild(
    Object.assign(document.createElement("fieldset"), { name: control.group, innerHTML: `<legend>${control.group}</legend>` }));
  const row = group.appendChild(Object.assign(document.createElement("div"), { className: "row" }));
  const label = `<label for="${control.name}">${control.label}</label>`;
  if (control.choices) {
    const options = Object.entries(control.choices).map(([name, text]) => `<option value="${name}">${text}</option>`);
    row.innerHTML = `${label}<select id="${control.name}">${options.join("")}</select>`;
    row.lastElementChild.oninput = ({ target }) => change(control, target.value);
  } else {
    row.innerHTML = `${label}<input type="number" id="${control.name}" min="${control.min}" max="${control.max}" step="any">`
      + `<span class="unit">${control.unit}</span><input type="range" aria-label="${control.label}, slider" min="0" max="${positions(control)}" step="1">`;
    const [, box, , slider] = row.children;
    box.title = `${control.min} to ${control.max} ${control.unit}`;
    box.onchange = () => fill(); // what is not allowed gives way to the value that is simulated
    box.oninput = () => box.value !== "" && box.validity.valid && change(control, tidy(box.valueAsNumber / control.per), box);
    slider.oninput = () => change(control, tidy(fromSlider(control, slider.valueAsNumber / positions(control)) / control.per), slider);
  }
  rows.set(control, row);
}

// Of a slider: each changes the value, which has three digits if it is logarithmic.
const positions = ({ min, max, step, log }) => (log ? Math.floor(Math.log(max / min) / Math.log(1.01)) : Math.round((max - min) / step));

function fromSlider({ min, max, step, log }, part) {
  const value = log ? min * (max / min) ** part : min + part * (max - min);
  return log ? Number(value.toPrecision(3)) : tidy(Math.round(value / step) * step);
}

function change(control, value, from) {
  if (!allowed(control, value)) return;
  values = { ...values, [control.name]: value };
  show(from);
  if (control.group !== "Excitation") search();
}

function fill(from) {
  for (const [control, row] of rows) {
    row.hidden = !used(control, values);
    if (control.choices) {
      row.lastElementChild.value = values[control.name];
      continue;
    }
    const [, box, , slider] = row.children;
    const shown = tidy(values[control.name] * control.per);
    const { min, max, log } = control;
    if (box !== from) box.value = Number(shown.toPrecision(6));
    if (slider !== from) slider.value = positions(control) * (log ? Math.log(shown / min) / Math.log(max / min) : (shown - min) / (max - min));
    slider.setAttribute("aria-valuetext", `${Number(shown.toPrecision(6))} ${control.unit}`);
  }
}

let named = 0;
function show(from) {
  fill(from);
  const scene = sceneOf(values);
  element("scene").textContent = scene;
  const hash = hashOf(values);
  element("link").value = location.href.replace(/#.*/, "") + (hash && `#${hash}`);
  send(scene);
  // Browsers refuse more than about ten a second, as a slider that is dragged would give.
  clearTimeout(named);
  named = setTimeout(() => history.replaceState(null, "", element("link").value), 300);
}

function load(hash) {
  values = valuesOf(hash);
  show();
  search();
}

CONTROLS.forEach(add);
element("controls").onsubmit = (event) => event.preventDefault();
element("reset").onclick = () => load("");
element("copy").onclick = async ({ target }) => {
  element("link").select();
  try {
    await navigator.clipboard.writeText(element("link").value);
    target.textContent = "Copied";
  } catch {
    target.textContent = "Select the link and copy it";
  }
  setTimeout(() => { target.textContent = "Copy link"; }, 2000);
};
element("save").onclick = () => {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([sceneOf(values)], { type: "application/toml" }));
  link.download = "scene.toml";
  link.click();
  URL.revokeObjectURL(link.href);
};
addEventListener("hashchange", () => load(location.hash));
addEventListener("resize", () => run && draw());
load(location.hash);
