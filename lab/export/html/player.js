// The player: loads the scene, plays it, and answers to buttons, fingers and keys.
const part = (name) => document.getElementById(name);
const START = { zoom: 1, x: 0, y: 0, azimuth: 0.5, elevation: 0.35 };

async function load() {
  const scene = JSON.parse(part("data").textContent);
  for (const shape of scene.shapes) {
    shape.stream = await decode(shape.place);
    shape.now = new Float32Array(shape.stream.row);
    shape.seen = new Float32Array((3 * shape.stream.row) / scene.axes);
  }
  for (const cloud of scene.clouds) {
    cloud.stream = await decode(cloud.place);
    const count = cloud.stream.row / scene.axes;
    cloud.now = new Float32Array(cloud.stream.row);
    cloud.seen = new Float32Array(3 * count);
    cloud.shades = new Uint8Array(count);
    cloud.radius = valuesAt(await decode(cloud.radius), 0, 0, new Float32Array(count));
    if (cloud.angle) [cloud.angle, cloud.angleNow] = [await decode(cloud.angle), new Float32Array(count)];
    for (const field of cloud.colours) [field.stream, field.now] = [await decode(field), new Float32Array(count)];
  }
  return scene;
}

function start(scene) {
  const last = scene.time.length - 1, span = [scene.time[0], scene.time[last]];
  const look = { ...START, frame: scene.first, colour: "" };
  const state = { time: span[0], playing: false, speed: 1, curve: scene.curves[0], ends: null };
  const canvas = part("picture"), plot = part("plot"), slider = part("slider");
  let waiting = false, before = 0;

  // As high as the scene is at this width, within what leaves room for the rest of the page.
  function shapeCanvas() {
    const wide = viewAt(scene, { ...START, frame: look.frame }, 0, 0, 1000, 1e9).scale;
    const high = viewAt(scene, { ...START, frame: look.frame }, 0, 0, 1e9, 1000).scale;
    const most = Math.min(0.62 * window.innerHeight, 640);
    canvas.style.height = `${Math.max(Math.min(240, most), Math.min(most, 1.12 * canvas.clientWidth * (wide / high)))}px`;
  }

  function paint(now) {
    waiting = false;
    if (state.playing) {
      state.time += (Math.min(now - before, 200) / 1000) * state.speed;
      if (state.time >= span[1]) { state.time = span[1]; play(false); }
    }
    before = now;
    const [context, width, height] = fitted(canvas);
    const [frame, share] = placeInTime(scene.time, state.time);
    const view = viewAt(scene, look, frame, share, width, height);
    context.clearRect(0, 0, width, height);
    (scene.axes === 2 ? paintPlane : paintSpace)(context, scene, view, look, frame, share);
    legend(scene, look);
    slider.value = (1000 * (state.time - span[0])) / (span[1] - span[0] || 1);
    part("clock").textContent = `${state.time.toFixed(2)} s`;
    if (state.curve) state.ends = paintCurve(plot, state.curve, state.time, span);
    if (state.playing) again();
  }

  function again() {
    if (!waiting) { waiting = true; requestAnimationFrame(paint); }
  }

  function play(on) {
    if (on && state.time >= span[1]) state.time = span[0];
    state.playing = on;
    before = performance.now();
    part("play").textContent = on ? "❚❚" : "▶";
    part("play").setAttribute("aria-label", on ? "Pause" : "Play");
    again();
  }

  function seek(share) {
    state.time = span[0] + Math.max(0, Math.min(1, share)) * (span[1] - span[0]);
    again();
  }

  choices("colour", coloursOf(scene), (value) => { look.colour = value; again(); });
  choices("frame", [["earth", "earth"], ["tank", "tank"]], (value) => { look.frame = value; shapeCanvas(); again(); }, look.frame);
  choices("speed", [0.1, 0.25, 0.5, 1, 2, 4, 10].map((x) => [x, `${x} ×`]), (value) => { state.speed = Number(value); }, 1);
  choices("curve", scene.curves.map((one, k) => [k, one.label.replaceAll("_", " ")]), (value) => { state.curve = scene.curves[value]; part("told").textContent = state.curve.about; again(); });
  if (state.curve) part("told").textContent = state.curve.about; else part("curves").hidden = true;
  part("play").onclick = () => play(!state.playing);
  part("reset").onclick = () => { Object.assign(look, START); again(); };
  slider.oninput = () => seek(slider.value / 1000);
  const along = (event) => seek((event.offsetX - state.ends.left) / (state.ends.right - state.ends.left));
  plot.onpointerdown = (event) => { plot.setPointerCapture(event.pointerId); along(event); };
  plot.onpointermove = (event) => { if (event.buttons) along(event); };
  hands(canvas, scene, look, again);
  document.onkeydown = (event) => {
    if (event.target.tagName === "SELECT") return;
    const steps = { ArrowLeft: -1, ArrowRight: 1 };
    if (event.key === " ") { event.preventDefault(); play(!state.playing); }
    else if (steps[event.key] && event.target !== slider) {
      const [frame] = placeInTime(scene.time, state.time);
      state.time = scene.time[Math.max(0, Math.min(last, frame + steps[event.key]))];
      again();
    }
  };
  window.onresize = () => { shapeCanvas(); again(); };
  const asked = new URLSearchParams(location.hash.slice(1)); // such as #time=1.5&colour=speed
  if (asked.has("time")) state.time = Math.max(span[0], Math.min(span[1], Number(asked.get("time")) || 0));
  for (const name of ["colour", "frame"]) {
    if (asked.has(name)) { part(name).value = look[name] = asked.get(name); }
  }
  shapeCanvas();
  again();
}

// What colours may show: the names of fields, and of kinds where there are several.
function coloursOf(scene) {
  const names = [...new Set(scene.clouds.flatMap((cloud) => cloud.colours.map((one) => one.name)))];
  const kinds = scene.clouds.some((cloud) => cloud.kinds && cloud.kinds.length > 1);
  return [["", kinds ? "kind" : "plain"], ...names.map((name) => [name, name])];
}

function choices(name, all, act, chosen) {
  const list = part(name);
  for (const [value, text] of all) list.add(new Option(text, value, false, value === chosen));
  list.onchange = () => act(list.value);
  if (all.length < 2) list.parentElement.hidden = true;
}

function legend(scene, look) {
  const said = scene.clouds.flatMap((cloud) => {
    const field = cloud.colours.find((one) => one.name === look.colour);
    if (field) {
      const bar = Array.from({ length: 9 }, (_, k) => shade(tableOf(cloud), k / 8)).join(",");
      const unit = field.unit === "1" ? "" : ` ${field.unit}`;
      return [["bar", `linear-gradient(to right,${bar})`, `${cloud.name}, ${field.name}: ${short(field.ends[0])} to ${short(field.ends[1])}${unit}`]];
    }
    if (!look.colour && cloud.kinds && cloud.kinds.length > 1) return cloud.kinds.map((kind, k) => ["dot", KINDS[k % KINDS.length], kind]);
    return scene.clouds.length > 1 ? [["dot", OWN[cloud.name], cloud.name]] : [];
  });
  const key = JSON.stringify(said);
  if (legend.key === key) return;
  legend.key = key;
  part("legend").replaceChildren(...said.map(([kind, colour, text]) => {
    const one = document.createElement("span"), mark = document.createElement("i");
    mark.className = kind;
    mark.style.background = colour;
    one.append(mark, text);
    return one;
  }));
}

// Drag moves a plane scene and turns one in space (with shift or two fingers it moves); wheel and pinch zoom.
function hands(canvas, scene, look, again) {
  const fingers = new Map();
  const zoom = (factor, x, y) => {
    const most = Math.max(0.2, Math.min(60, look.zoom * factor)) / look.zoom;
    const dx = x - canvas.clientWidth / 2, dy = y - canvas.clientHeight / 2;
    look.x = dx + most * (look.x - dx);
    look.y = dy + most * (look.y - dy);
    look.zoom *= most;
    again();
  };
  canvas.onwheel = (event) => { event.preventDefault(); zoom(Math.exp(-0.0015 * event.deltaY), event.offsetX, event.offsetY); };
  canvas.onpointerdown = (event) => { canvas.setPointerCapture(event.pointerId); fingers.set(event.pointerId, [event.offsetX, event.offsetY]); };
  canvas.onpointerup = canvas.onpointercancel = (event) => fingers.delete(event.pointerId);
  canvas.onpointermove = (event) => {
    const was = fingers.get(event.pointerId);
    if (!was) return;
    const now = [event.offsetX, event.offsetY], dx = now[0] - was[0], dy = now[1] - was[1];
    const other = [...fingers].find(([id]) => id !== event.pointerId);
    if (other) {
      const [ox, oy] = other[1], size = (p) => Math.hypot(p[0] - ox, p[1] - oy) || 1;
      look.x += dx / 2; look.y += dy / 2;
      zoom(size(now) / size(was), (now[0] + ox) / 2, (now[1] + oy) / 2);
    } else if (scene.axes === 3 && !event.shiftKey) {
      look.azimuth -= 0.008 * dx;
      look.elevation = Math.max(-1.5, Math.min(1.5, look.elevation + 0.008 * dy));
    } else { look.x += dx; look.y += dy; }
    fingers.set(event.pointerId, now);
    again();
  };
}

if (typeof document !== "undefined") {
  load().then(start).catch((error) => {
    part("note").textContent = `This browser cannot show the scene (${error.message}): a newer one is needed.`;
  });
}
