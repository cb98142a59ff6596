// What can be set, and the scene file that says it. Values are in SI units, as in the component; a control shows `value * per`.
const G = 9.80665;
const LAWS = { Hertz: "Hertz", Linearised: "Linearised about the preload", Rough: "Rough surfaces" };
const EXCITATIONS = { Sine: "Sine", HalfSine: "Shock, half sine" };
const CONTROLS = [
  { group: "Spring", name: "beam.length", label: "Length", unit: "mm", per: 1e3, min: 8, max: 30, step: 0.1 },
  { group: "Spring", name: "beam.thickness", label: "Thickness (equivalent)", unit: "mm", per: 1e3, min: 0.06, max: 0.25, step: 0.001 },
  { group: "Spring", name: "tip.mass", label: "Mass of the rivet", unit: "mg", per: 1e6, min: 0, max: 100, step: 0.1 },
  { group: "Contact", name: "contact.overtravel", label: "Overtravel", unit: "mm", per: 1e3, min: 0.02, max: 0.6, step: 0.005 },
  { group: "Contact", name: "effects.contactLaw", label: "Law", choices: LAWS },
  { group: "Contact", name: "contact.curvatureRadius", label: "Radius", unit: "mm", per: 1e3, min: 0.5, max: 100, step: 0.01, log: true, only: ["effects.contactLaw", "Hertz", "Linearised"] },
  { group: "Contact", name: "contact.stiffness", label: "Stiffness at 0.152 N", unit: "N/mm", per: 1e-3, min: 1, max: 10000, step: 0.1, log: true, only: ["effects.contactLaw", "Rough"] },
  { group: "Contact", name: "contact.stiffnessExponent", label: "Exponent of the stiffness", unit: "", per: 1, min: 0, max: 0.9, step: 0.01, only: ["effects.contactLaw", "Rough"] },
  { group: "Contact", name: "contact.damping", label: "Damping time", unit: "µs", per: 1e6, min: 0, max: 300, step: 0.01 },
  { group: "Excitation", name: "effects.excitation", label: "Kind", choices: EXCITATIONS },
  { group: "Excitation", name: "excitation.amplitude", label: "Amplitude; negative pulls", unit: "g", per: 1 / G, min: -150, max: 150, step: 0.1 },
  { group: "Excitation", name: "excitation.frequency", label: "Frequency", unit: "Hz", per: 1, min: 20, max: 5000, step: 1, log: true, only: ["effects.excitation", "Sine"] },
  { group: "Excitation", name: "excitation.duration", label: "Duration", unit: "ms", per: 1e3, min: 0.2, max: 20, step: 0.1, only: ["effects.excitation", "HalfSine"] },
];
const START = JSON.parse(document.getElementById("start").textContent);
for (const control of CONTROLS) if (control.choices) START[control.name] = Object.keys(control.choices)[0];

const used = (control, values) => !control.only || control.only.slice(1).includes(values[control.only[0]]);
// Of a product of units nothing but what rounding left is cut off.
const tidy = (value) => Number(value.toPrecision(13));
const allowed = (control, value) =>
  control.choices ? Object.hasOwn(control.choices, value)
    : Number.isFinite(value) && tidy(value * control.per) >= control.min && tidy(value * control.per) <= control.max;

// Of the part of an address after #; what it does not name, or names wrongly, has its start value.
function valuesOf(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  return Object.fromEntries(CONTROLS.map((control) => {
    const text = given.get(control.name);
    const value = control.choices ? text : Number(text);
    return [control.name, text !== null && text !== "" && allowed(control, value) ? value : START[control.name]];
  }));
}

function hashOf(values) {
  const changed = CONTROLS.filter(({ name }) => values[name] !== START[name]);
  return new URLSearchParams(changed.map(({ name }) => [name, String(values[name])])).toString();
}

const PERIODS = 20;
const POINTS = 2000;
const OUTPUTS = ["contact.force", "contact.resistance", "step.maximumResistance", "chatter.count", "chatter.longestInterruption"];

function sceneOf(values) {
  const sine = values["effects.excitation"] === "Sine";
  const duration = values["excitation.duration"];
  const stop = sine ? PERIODS / values["excitation.frequency"] : Math.max(3 * duration, duration + 0.01);
  const title = sine ? `${PERIODS} periods of a sine` : "A shock";
  const set = CONTROLS.filter((control) => used(control, values) && (values[control.name] !== START[control.name] || control.name.startsWith("excitation.")));
  const lines = set.map(({ name, choices }) => `${name} = ${choices ? JSON.stringify(values[name]) : String(values[name])}`);
  if (!lines.some((line) => line.startsWith("effects.excitation"))) lines.push('effects.excitation = "Sine"');
  return [
    `title = "${title}, from the page"`, `stop = ${stop}`, `communicationStep = ${stop / POINTS}`,
    `outputs = ${JSON.stringify(OUTPUTS)}`, "", "[parameters]", ...lines, "",
  ].join("\n");
}
