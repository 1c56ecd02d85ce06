// The sliders of a panel choose one of the pictures that its page holds: see tools/draggable.py.
document.addEventListener("DOMContentLoaded", () => {
  for (const panel of document.querySelectorAll(".draggable")) {
    const { parts, pictures } = JSON.parse(panel.querySelector("script").textContent);
    const sliders = [...panel.querySelectorAll("input")];
    const show = () => {
      let which = 0;
      for (const slider of sliders) {
        which = which * (Number(slider.max) + 1) + slider.valueAsNumber;
        slider.nextElementSibling.value = slider.dataset.values.split(" ")[slider.valueAsNumber];
      }
      panel.querySelector(".picture").innerHTML = pictures[which].map((part) => parts[part]).join("");
    };
    for (const slider of sliders) slider.addEventListener("input", show);
    show(); // a browser may keep where a slider was
  }
});
