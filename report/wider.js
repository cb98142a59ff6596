// Tables wider than the window say so.
const mark = () => document.querySelectorAll(".scroll").forEach(
  (table) => table.classList.toggle("wider", table.scrollWidth > table.clientWidth));
mark();
addEventListener("resize", mark);
