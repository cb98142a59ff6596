"use strict";

// Draws the figures that the element #figures describes, in the colours of the style sheet, and marks tables wider than the
// window.
const described = document.getElementById("figures").textContent;
const config = {
  displaylogo: false,
  modeBarButtons: [["toImage"], ["zoom2d", "pan2d"], ["zoomIn2d", "zoomOut2d", "resetScale2d"]],
};
// Where a finger drags, the page has to scroll; the buttons zoom.
const dragmode = matchMedia("(pointer: coarse)").matches ? false : "zoom";

function draw() {
  const style = getComputedStyle(document.documentElement);
  const colour = (key, value) =>
    key.endsWith("color") && value.startsWith("--") ? style.getPropertyValue(value).trim() : value;
  for (const { id, data, layout } of JSON.parse(described, colour)) {
    const plot = document.querySelector(`#${id} .plot`);
    const width = plot.clientWidth;
    const narrow = width < 600;
    const margin = { l: 60, r: 25, t: narrow ? 35 : 15, b: 55 };
    if (layout.showlegend) {
      // plotly.js gives each entry the width of the longest name.
      const entry = 50 + 7 * Math.max(...data.map((curve) => curve.name.length));
      const columns = Math.max(1, Math.floor((width - margin.l - margin.r) / entry));
      margin.b += 21 * Math.ceil(data.length / columns);
    }
    const height = (narrow ? 270 : 340) + margin.b;
    if (narrow) {
      layout.xaxis.dtick = layout.xaxis.narrowdtick ?? layout.xaxis.dtick;
    }
    // The same `uirevision` keeps what the reader zoomed and hid.
    Plotly.react(plot, data, { ...layout, width, height, margin, dragmode, uirevision: 1 }, config);
  }
  for (const table of document.querySelectorAll(".scroll")) {
    table.classList.toggle("wider", table.scrollWidth > table.clientWidth);
  }
}

draw();

let width = innerWidth;
addEventListener("resize", () => {
  if (innerWidth !== width) {
    width = innerWidth;
    draw();
  }
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);

// Paper is white.
for (const event of ["beforeprint", "afterprint"]) {
  addEventListener(event, () => {
    document.documentElement.classList.toggle("printed", event === "beforeprint");
    draw();
  });
}
