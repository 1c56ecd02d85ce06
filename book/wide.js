// What is wider than the page scrolls inside itself, and a line above it says so (style.css).
const mark = () => document.querySelectorAll(".cell_output, .table-wrapper, div.math, article p:has(> img)").forEach(
  box => box.classList.toggle("bc-scrolls", box.scrollWidth > box.clientWidth + 1));
addEventListener("load", mark);
addEventListener("resize", mark);
