// Scenes in space: a parallel view that a drag turns; far walls, then balls from far to near, then the edges of near walls.
const BALL = 48, BALLS = new Map();

function ball(colour) {
  if (!BALLS.has(colour)) {
    const picture = document.createElement("canvas");
    picture.width = picture.height = BALL;
    const context = picture.getContext("2d"), half = BALL / 2;
    context.beginPath();
    context.arc(half, half, half - 0.5, 0, 7);
    context.fillStyle = colour;
    context.fill();
    const light = context.createRadialGradient(0.7 * half, 0.6 * half, 0.1 * half, half, half, half);
    light.addColorStop(0, "rgba(255,255,255,0.45)");
    light.addColorStop(0.45, "rgba(255,255,255,0)");
    light.addColorStop(1, "rgba(0,0,0,0.45)");
    context.fillStyle = light;
    context.fill();
    BALLS.set(colour, picture);
  }
  return BALLS.get(colour);
}

// Whether each face is seen from the side on which its corners run counter-clockwise.
function facing(shape, at) {
  return shape.cells.map((cell) => {
    let area = 0;
    cell.forEach((k, n) => {
      const j = cell[(n + 1) % cell.length];
      area += at[3 * k] * at[3 * j + 1] - at[3 * j] * at[3 * k + 1];
    });
    return area < 0; // rows of the canvas run downwards
  });
}

function paintFaces(context, shape, at, seen, fill) {
  context.fillStyle = fill;
  shape.cells.forEach((cell, n) => {
    if (!seen[n]) return;
    context.beginPath();
    trace(context, at, cell);
    context.closePath();
    context.fill();
  });
}

function paintEdges(context, shape, at, wanted, colour, width) {
  context.beginPath();
  for (const [a, b, one, two, sharp] of shape.edges) {
    if (!wanted(one, two, sharp)) continue;
    context.moveTo(at[3 * a], at[3 * a + 1]);
    context.lineTo(at[3 * b], at[3 * b + 1]);
  }
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.lineCap = "round";
  context.stroke();
}

function paintBalls(context, scene, view, look, frame, share) {
  const drawn = [];
  scene.clouds.forEach((cloud) => {
    const at = project(view, 3, valuesAt(cloud.stream, frame, share, cloud.now), cloud.seen);
    const [which, colours] = colouring(cloud, look.colour, frame, share);
    const pictures = colours.map(ball), grown = cloud.name === "water" ? 1.2 : 1;
    for (let k = 0; k < which.length; k++) {
      if (at[3 * k] === at[3 * k]) drawn.push([at[3 * k + 2], at[3 * k], at[3 * k + 1], grown * view.scale * cloud.radius[k], pictures[which[k]]]);
    }
  });
  drawn.sort((one, two) => one[0] - two[0]);
  for (const [, x, y, r, picture] of drawn) context.drawImage(picture, x - r, y - r, 2 * r, 2 * r);
}

function paintSpace(context, scene, view, look, frame, share) {
  const made = scene.shapes.map((shape) => {
    const at = project(view, 3, valuesAt(shape.stream, frame, share, shape.now), shape.seen);
    return [shape, at, facing(shape, at)];
  });
  const lines = { hull: ["#8d99a5", 1], parts: ["#59626b", 1.2], tank: ["#20262c", 1.5] };
  for (const [shape, at, seen] of made) {
    if (shape.name === "tank") paintFaces(context, shape, at, seen, "rgba(226, 222, 212, 0.75)");
    if (shape.name === "waterline") paintFaces(context, shape, at, seen.map(() => true), "rgba(60, 130, 190, 0.22)");
    if (shape.name === "hull") paintEdges(context, shape, at, (a, b, sharp) => sharp, ...lines.hull);
    if (shape.name === "tank") {
      const far = (one, two, sharp) => (seen[one] || (two >= 0 && seen[two])) && (sharp || seen[one] !== seen[two]);
      paintEdges(context, shape, at, far, "#7d858d", 1.2);
    }
  }
  paintBalls(context, scene, view, look, frame, share);
  for (const [shape, at, seen] of made) {
    if (shape.name === "parts") paintFaces(context, shape, at, seen.map(() => true), "rgba(120, 130, 140, 0.25)");
    if (shape.name === "parts") paintEdges(context, shape, at, (a, b, sharp) => sharp, ...lines.parts);
    if (shape.name !== "tank") continue;
    const near = (one, two, sharp) => !seen[one] && (two < 0 || !seen[two]) && sharp;
    const rim = (one, two) => two >= 0 && seen[one] !== seen[two];
    paintEdges(context, shape, at, near, "rgba(32, 38, 44, 0.35)", 1.2);
    paintEdges(context, shape, at, rim, lines.tank[0], lines.tank[1]);
  }
}
