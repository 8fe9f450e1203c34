"use strict";
// Two of the pictures lie on top of each other, and a slider moves the border between them.
for (const grid of document.querySelectorAll(".pictures")) {
  const pictures = [...grid.querySelectorAll("img")];
  const comparison = document.querySelector("template").content.firstElementChild.cloneNode(true);
  grid.before(comparison);
  const panes = comparison.querySelector(".panes");
  const slider = comparison.querySelector("input");

  function choose(side, index) {
    const select = comparison.querySelector(`select.${side}`);
    select.append(...pictures.map((picture, number) => new Option(picture.alt, number, false, number === index)));
    const show = () => {
      const pane = comparison.querySelector(`img.${side}`);
      pane.src = pictures[select.value].src;
      pane.alt = pictures[select.value].alt;
      pane.style.imageRendering = pane.naturalWidth < pane.clientWidth ? "pixelated" : "auto";
    };
    select.addEventListener("change", show);
    show();
  }

  const move = () => panes.style.setProperty("--border", `${slider.value}%`);

  function drag(event) {
    if (event.buttons) {
      const box = panes.getBoundingClientRect();
      slider.value = (100 * (event.clientX - box.left)) / box.width;
      move();
    }
  }

  choose("left", 0);
  choose("right", Math.min(2, pictures.length - 1));
  slider.addEventListener("input", move);
  panes.addEventListener("pointerdown", drag);
  panes.addEventListener("pointermove", drag);
  move();
}
