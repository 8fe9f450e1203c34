// The page's side of `minirt.notebook.widget`: shows frames, and sends keys and mouse.

const CURSORS = { arrow: "default", move: "move", turn: "crosshair", grab: "grabbing", none: "none" };
const STEP = 100; // pixels of scrolling that are one step of the wheel
const LEFT_TO_BROWSER = new Set(["F5", "F11", "F12"]);
const IS_MAC = /Mac/.test(navigator.platform);

function modifiers(event) {
  return { shift: event.shiftKey, ctrl: event.ctrlKey, alt: event.altKey, command: IS_MAC && event.metaKey };
}

function render({ model, el }) {
  const canvas = document.createElement("canvas");
  canvas.width = model.get("width");
  canvas.height = model.get("height");
  canvas.tabIndex = 0;
  canvas.className = "minirt-viewer";
  canvas.setAttribute("role", "application");
  canvas.setAttribute("aria-label", "miniRT: a click takes the keyboard, Escape gives it back, H shows the keys");
  canvas.style.cssText = "max-width: 100%; background: black; touch-action: none; outline-offset: 2px;";
  el.setAttribute("data-lm-suppress-shortcuts", "true"); // JupyterLab leaves keys to this element
  el.appendChild(canvas);
  const context = canvas.getContext("2d");

  function send(kind, event, more) {
    model.send({ kind, ...(event ? modifiers(event) : {}), ...more });
  }

  function place(event) {
    const box = canvas.getBoundingClientRect();
    return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height };
  }

  async function show(number, data) {
    try {
      const picture = await createImageBitmap(new Blob([data], { type: "image/jpeg" }));
      context.drawImage(picture, 0, 0, canvas.width, canvas.height);
      picture.close();
      canvas.dataset.frame = number;
    } finally {
      send("shown", null, { number });
    }
  }

  function receive(message, buffers) {
    if (message.kind === "frame") show(message.number, buffers[0]);
    else if (message.kind === "pointer") canvas.style.cursor = CURSORS[message.cursor];
    else if (message.kind === "release") canvas.blur();
    else if (message.kind === "copy") navigator.clipboard?.writeText(message.text).catch(() => {});
    else if (message.kind === "full screen") {
      if (message.on) canvas.requestFullscreen?.().catch(() => {});
      else if (document.fullscreenElement) document.exitFullscreen();
    } else if (message.kind === "failure") {
      const line = el.appendChild(document.createElement("pre"));
      line.textContent = message.text;
    }
  }

  const held = new Set(); // keys that went down here: their releases are ours, too

  function key(event, down) {
    if (LEFT_TO_BROWSER.has(event.key)) return;
    event.preventDefault();
    event.stopPropagation();
    if (event.repeat || (!down && !held.has(event.code))) return;
    if (down) held.add(event.code);
    else held.delete(event.code);
    send(down ? "key down" : "key up", event, { key: event.key, code: event.code, location: event.location });
  }

  let motion = null; // the last one that was not sent yet: one a frame of the browser is enough

  function flushMotion() {
    if (motion) send("motion", motion, place(motion));
    motion = null;
  }

  function move(event) {
    if (!motion) requestAnimationFrame(flushMotion);
    motion = event;
  }

  function button(event, down) {
    event.preventDefault();
    flushMotion();
    if (down) {
      canvas.focus({ preventScroll: true });
      canvas.setPointerCapture(event.pointerId);
    }
    send(down ? "button down" : "button up", event, { button: event.button, ...place(event) });
  }

  let wheel = [0, 0]; // pixels of scrolling that are no step yet

  function scroll(event) {
    if (document.activeElement !== canvas) return; // the notebook scrolls
    event.preventDefault();
    const unit = event.deltaMode ? STEP / 3 : 1; // lines, of which three are a step
    wheel = [wheel[0] + event.deltaX * unit, wheel[1] - event.deltaY * unit];
    const [right, up] = wheel.map((each) => Math.trunc(each / STEP));
    wheel = [wheel[0] - right * STEP, wheel[1] - up * STEP];
    if (right || up) send("wheel", event, { right, up, ...place(event) });
  }

  canvas.addEventListener("keydown", (event) => key(event, true));
  canvas.addEventListener("keyup", (event) => key(event, false));
  canvas.addEventListener("pointerdown", (event) => button(event, true));
  canvas.addEventListener("pointerup", (event) => button(event, false));
  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerenter", () => send("enter"));
  canvas.addEventListener("pointerleave", () => send("leave"));
  canvas.addEventListener("wheel", scroll, { passive: false });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("focus", () => send("focus"));
  canvas.addEventListener("blur", () => {
    held.clear();
    send("blur");
  });
  model.on("msg:custom", receive);
  send("ready");
  return () => model.off("msg:custom", receive);
}

export default { render };
