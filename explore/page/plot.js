// Curves in an SVG, redrawn as a whole.
const MARGIN = { left: 58, right: 22, top: 22, bottom: 34 };

function ticks(low, high, log) {
  if (log) {
    const found = [];
    const wide = Math.log10(high / low) > 2.5;
    for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); decade++) {
      for (const factor of wide ? [1] : [1, 2, 5]) found.push(Number((factor * 10 ** decade).toPrecision(3)));
    }
    return found.filter((tick) => tick >= low * 0.999 && tick <= high * 1.001);
  }
  const rough = (high - low) / 5 || 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((each) => each >= rough);
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, n) => Number(((first + n) * step).toPrecision(6)));
}

// {x: {low, high, log, label}, y, bands: [[from, to]], curves: [{x, y, to, kind}], marks: [{y, text}], here: [x, y]}
function plot(svg, { x, y, bands = [], curves = [], marks = [], here }) {
  const { clientWidth: width, clientHeight: height } = svg;
  const scale = ({ low, high, log }, from, to) => {
    const part = log ? (value) => Math.log(value / low) / Math.log(high / low) : (value) => (value - low) / (high - low);
    return (value) => (from + Math.min(Math.max(part(value), -0.5), 1.5) * (to - from)).toFixed(1);
  };
  const [left, right, top, bottom] = [MARGIN.left, width - MARGIN.right, MARGIN.top, height - MARGIN.bottom];
  const across = scale(x, left, right);
  const up = scale(y, bottom, top);
  const parts = [`<clipPath id="${svg.id}-clip"><rect x="${left}" y="${top}" width="${right - left}" height="${bottom - top}"/></clipPath>`];
  const inside = [];
  for (const [from, to] of bands) {
    inside.push(`<rect class="open" x="${across(from)}" y="${top}" width="${Math.max(across(to) - across(from), 1)}" height="${bottom - top}"/>`);
  }
  const few = right - left < 500;
  ticks(x.low, x.high, x.log).forEach((tick, n) => {
    parts.push(`<path class="grid" d="M${across(tick)} ${top}V${bottom}"/>`);
    if (!few || n % 2 === 0) parts.push(`<text x="${across(tick)}" y="${bottom + 15}" text-anchor="middle">${tick}</text>`);
  });
  for (const tick of ticks(y.low, y.high, y.log)) {
    parts.push(`<path class="grid" d="M${left} ${up(tick)}H${right}"/><text x="${left - 6}" y="${+up(tick) + 4}" text-anchor="end">${tick}</text>`);
  }
  for (const curve of curves) {
    const points = (values) => Array.from(curve.x, (value, n) => `${across(value)} ${up(values[n])}`);
    if (curve.to) inside.push(`<path class="reach" d="M${points(curve.y).concat(points(curve.to).reverse()).join("L")}Z"/>`);
    else if (curve.x.length) inside.push(`<path class="${curve.kind ?? "curve"}" d="M${points(curve.y).join("L")}"/>`);
  }
  for (const { y: value, text } of marks) {
    inside.push(`<path class="mark" d="M${left} ${up(value)}H${right}"/><text class="mark-text" x="${right - 4}" y="${+up(value) - 4}" text-anchor="end">${text}</text>`);
  }
  if (here) inside.push(`<circle class="here" cx="${across(here[0])}" cy="${up(here[1])}" r="5"/>`);
  parts.push(`<g clip-path="url(#${svg.id}-clip)">${inside.join("")}</g><rect class="frame" x="${left}" y="${top}" width="${right - left}" height="${bottom - top}"/>`);
  parts.push(`<text x="${left}" y="14">${y.label}</text><text x="${right}" y="${height - 4}" text-anchor="end">${x.label}</text>`);
  svg.innerHTML = parts.join("");
}
