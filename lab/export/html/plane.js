// Scenes in the plane: sea, hull and tank as lines, particles as discs or outlines.
const LOOKS = {
  house: { fill: "#cfd6dc" }, hull: { fill: "#b7c1ca", line: "#39434d", width: 2 }, tank: { line: "#20262c", width: 2.5 },
  parts: { line: "#59626b", width: 2.5 },
};
const SEA = "rgba(60, 130, 190, 0.30)", SURFACE = "#2b6ca3", HOLD = "#fbfaf6";

function trace(context, at, cell) {
  cell.forEach((k, n) => (n ? context.lineTo(at[3 * k], at[3 * k + 1]) : context.moveTo(at[3 * k], at[3 * k + 1])));
}

function paintSea(context, view, shape, at) {
  const cell = shape.cells[0], first = cell[0], last = cell[cell.length - 1];
  context.beginPath();
  context.moveTo(-10, at[3 * first + 1]);
  for (const k of cell) context.lineTo(at[3 * k], at[3 * k + 1]);
  context.lineTo(view.width + 10, at[3 * last + 1]);
  context.strokeStyle = SURFACE;
  context.lineWidth = 1.5;
  context.stroke();
  context.lineTo(view.width + 10, view.height + 10);
  context.lineTo(-10, view.height + 10);
  context.fillStyle = SEA;
  context.fill();
}

function paintShape(context, shape, at) {
  const look = LOOKS[shape.name] || LOOKS.parts;
  context.beginPath();
  for (const cell of shape.cells) trace(context, at, cell);
  if (look.fill) { context.fillStyle = look.fill; context.fill("evenodd"); }
  if (!look.line) return;
  context.strokeStyle = look.line;
  context.lineWidth = look.width;
  context.lineJoin = context.lineCap = "round";
  context.stroke();
}

// What closed lines of parts bound: solid bodies, and the walls of hulls between their outlines and their rooms.
function paintSolid(context, shape, at) {
  context.beginPath();
  for (const cell of shape.cells) {
    const a = cell[0], b = cell[cell.length - 1];
    if (cell.length > 3 && Math.hypot(at[3 * a] - at[3 * b], at[3 * a + 1] - at[3 * b + 1]) < 1e-3) trace(context, at, cell);
  }
  context.fillStyle = "#b3bac1";
  context.fill("evenodd");
}

// The inside of the tank: the outline that its edges leave, whose open ones are closed for it.
function paintHold(context, shape, at) {
  context.beginPath();
  const points = shape.cells.flatMap((cell) => cell);
  points.forEach((k, n) => (n ? context.lineTo(at[3 * k], at[3 * k + 1]) : context.moveTo(at[3 * k], at[3 * k + 1])));
  context.fillStyle = HOLD;
  context.fill();
}

function paintDiscs(context, view, cloud, at, chosen, frame, share) {
  const [which, colours] = colouring(cloud, chosen, frame, share), count = which.length;
  const wet = cloud.name === "water" || cloud.name === "air" || cloud.name === "bulk";
  const grown = wet ? 1.27 : 1; // no gaps in what flows
  const angle = cloud.angle ? valuesAt(cloud.angle, frame, share, cloud.angleNow) : null;
  const marks = [];
  for (let c = 0; c < colours.length; c++) {
    context.beginPath();
    for (let k = 0; k < count; k++) {
      const x = at[3 * k], y = at[3 * k + 1];
      if (which[k] !== c || !(x === x)) continue;
      const r = grown * view.scale * cloud.radius[k];
      if (x < -r || y < -r || x > view.width + r || y > view.height + r) continue;
      if (cloud.outlines.length) outline(context, cloud.outlines[cloud.which[k]], x, y, r, angle[k] + view.angle);
      else if (wet && r < 3) context.rect(x - r, y - r, 2 * r, 2 * r);
      else { context.moveTo(x + r, y); context.arc(x, y, r, 0, 7); }
      if (angle && r > 3.5) marks.push(x, y, 0.8 * r, angle[k] + view.angle);
    }
    context.fillStyle = colours[c];
    context.fill();
    if (!wet && view.scale * cloud.radius[0] > 2.5) {
      context.strokeStyle = "rgba(30, 25, 20, 0.45)";
      context.lineWidth = 0.7;
      context.stroke();
    }
  }
  context.beginPath();
  for (let k = 0; k < marks.length; k += 4) {
    context.moveTo(marks[k], marks[k + 1]);
    context.lineTo(marks[k] + marks[k + 2] * Math.cos(marks[k + 3]), marks[k + 1] - marks[k + 2] * Math.sin(marks[k + 3]));
  }
  context.strokeStyle = "rgba(30, 25, 20, 0.4)";
  context.lineWidth = 1;
  context.stroke();
}

function outline(context, corners, x, y, r, angle) {
  const c = r * Math.cos(angle), s = r * Math.sin(angle);
  corners.forEach(([a, b], n) => {
    const px = x + c * a - s * b, py = y - s * a - c * b;
    if (n) context.lineTo(px, py); else context.moveTo(px, py);
  });
  context.closePath();
}

function paintPlane(context, scene, view, look, frame, share) {
  const shapes = Object.fromEntries(scene.shapes.map((shape) => [shape.name, shape]));
  const order = ["house", "waterline", "hull", "tank-inside"];
  const at = {};
  for (const shape of scene.shapes) at[shape.name] = project(view, 2, valuesAt(shape.stream, frame, share, shape.now), shape.seen);
  for (const name of order) {
    if (name === "tank-inside") paintHold(context, shapes.tank, at.tank);
    else if (!shapes[name]) continue;
    else if (name === "waterline") paintSea(context, view, shapes[name], at[name]);
    else paintShape(context, shapes[name], at[name]);
  }
  const last = ["grains", "fixed"]; // over what flows
  for (const cloud of [...scene.clouds].sort((a, b) => last.includes(a.name) - last.includes(b.name))) {
    const seen = project(view, 2, valuesAt(cloud.stream, frame, share, cloud.now), cloud.seen);
    paintDiscs(context, view, cloud, seen, look.colour, frame, share);
  }
  if (shapes.parts) paintSolid(context, shapes.parts, at.parts);
  for (const name of ["tank", "parts"]) if (shapes[name]) paintShape(context, shapes[name], at[name]);
}
