// Where things stand on the canvas: the pose of the tank, the camera, and colours.
const SCALE = [[49, 54, 149], [69, 117, 180], [116, 173, 209], [171, 217, 190], [254, 224, 120], [244, 140, 67], [190, 30, 45]];
const DEEP = [[16, 52, 110], [28, 92, 170], [58, 140, 212], [120, 190, 232], [200, 232, 246]];
const KINDS = ["#c98f3c", "#0072b2", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#8c6d31", "#f0e442"];
const OWN = { grains: "#c98f3c", water: "#3b8fd6", air: "#d7e3ea", bulk: "#b98a4a", fixed: "#8d949b" };
const SHADES = 24;

function shade(table, share) {
  const place = Math.max(0, Math.min(1, share)) * (table.length - 1);
  const k = Math.min(table.length - 2, Math.floor(place));
  const mixed = table[k].map((one, c) => Math.round(one + (place - k) * (table[k + 1][c] - one)));
  return `rgb(${mixed.join(",")})`;
}

function tableOf(cloud) {
  return cloud.name === "water" ? DEEP : SCALE;
}

// The picture at a time (s): the number of the picture before it, and how far it is to the next.
function placeInTime(times, time) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) low = middle; else high = middle - 1;
  }
  const length = low + 1 < times.length ? times[low + 1] - times[low] : 0;
  return [low, length > 0 ? Math.max(0, Math.min(1, (time - times[low]) / length)) : 0];
}

// Axes of the camera in the order right, up, towards us; vectors are y, z, x.
function cameraAxes(scene, look) {
  if (scene.axes === 2) return [1, 0, 0, 0, 1, 0, 0, 0, 1];
  const a = look.azimuth, e = look.elevation;
  const [sa, ca, se, ce] = [Math.sin(a), Math.cos(a), Math.sin(e), Math.cos(e)];
  return [ca, 0, -sa, -se * sa, ce, -se * ca, ce * sa, se, ce * ca];
}

function times(one, two) {
  const found = [];
  for (let r = 0; r < 3; r++) for (let c = 0; c < 3; c++) {
    found.push(one[3 * r] * two[c] + one[3 * r + 1] * two[3 + c] + one[3 * r + 2] * two[6 + c]);
  }
  return found;
}

function turned(m, p) {
  return [0, 1, 2].map((r) => m[3 * r] * p[0] + m[3 * r + 1] * p[1] + m[3 * r + 2] * p[2]);
}

// From points of the tank to the canvas: x = s m0·p + o0, y = −s m1·p + o1, depth = m2·p + o2.
function viewAt(scene, look, frame, share, width, height) {
  const camera = cameraAxes(scene, look);
  let matrix = camera, offset = [0, 0, 0];
  const one = scene.pose[frame], two = scene.pose[Math.min(frame + 1, scene.pose.length - 1)];
  const pose = one.map((x, k) => x + share * (two[k] - x));
  if (look.frame === "earth") {
    matrix = times(camera, pose.slice(3));
    offset = turned(camera, pose.slice(0, 3));
  }
  const [low, high] = scene.box[look.frame];
  let ends = [[Infinity, Infinity], [-Infinity, -Infinity]];
  for (let k = 0; k < 8; k++) {
    const seen = turned(camera, [0, 1, 2].map((c) => ((k >> c) & 1 ? high : low)[c]));
    ends = [[0, 1].map((c) => Math.min(ends[0][c], seen[c])), [0, 1].map((c) => Math.max(ends[1][c], seen[c]))];
  }
  const size = [0, 1].map((c) => Math.max(ends[1][c] - ends[0][c], 1e-9));
  const scale = 0.92 * Math.min(width / size[0], height / size[1]) * look.zoom;
  const middle = [0, 1].map((c) => (ends[0][c] + ends[1][c]) / 2);
  const origin = [width / 2 + look.x - scale * middle[0], height / 2 + look.y + scale * middle[1]];
  return { m: matrix, scale, x: origin[0] + scale * offset[0], y: origin[1] - scale * offset[1], depth: offset[2], origin,
    angle: look.frame === "earth" ? Math.atan2(pose[6], pose[3]) : 0, width, height };
}

// Points of a thing on the canvas: x, y and depth of each.
function project(view, axes, points, out) {
  const { m, scale, x, y, depth } = view;
  for (let k = 0, j = 0; k < points.length; k += axes, j += 3) {
    const a = points[k], b = points[k + 1], c = axes === 3 ? points[k + 2] : 0;
    out[j] = x + scale * (m[0] * a + m[1] * b + m[2] * c);
    out[j + 1] = y - scale * (m[3] * a + m[4] * b + m[5] * c);
    out[j + 2] = depth + m[6] * a + m[7] * b + m[8] * c;
  }
  return out;
}

// The shade of each particle, 0 to SHADES − 1 or a kind's number, and the colours of these.
function colouring(cloud, chosen, frame, share) {
  const field = cloud.colours.find((one) => one.name === chosen);
  if (field) {
    const values = valuesAt(field.stream, frame, share, field.now), span = field.ends[1] - field.ends[0] || 1;
    const which = cloud.shades;
    for (let k = 0; k < which.length; k++) {
      which[k] = Math.max(0, Math.min(SHADES - 1, Math.floor(((values[k] - field.ends[0]) / span) * SHADES)));
    }
    return [which, Array.from({ length: SHADES }, (_, k) => shade(tableOf(cloud), k / (SHADES - 1)))];
  }
  if (cloud.kind && cloud.kinds.length > 1) return [cloud.kind, cloud.kinds.map((_, k) => KINDS[k % KINDS.length])];
  return [cloud.shades.fill(0), [OWN[cloud.name] || OWN.grains]];
}
