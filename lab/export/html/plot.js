// The curve of a series with a mark at the time that is shown.
function niceStep(span, count) {
  const raw = span / count, power = 10 ** Math.floor(Math.log10(raw)), share = raw / power;
  return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

function ticks(low, high, count) {
  const step = niceStep(high - low || 1, count), found = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return found;
}

function short(number) {
  return String(Number(number.toPrecision(3 + (Math.abs(number) >= 1000)))).replaceAll("-", "−");
}

function paintCurve(canvas, curve, time, span) {
  const [context, width, height] = fitted(canvas);
  const known = curve.values.filter((value) => value !== null);
  let low = Math.min(...known), high = Math.max(...known);
  const room = 0.06 * (high - low || 1);
  low -= room; high += room;
  const left = 58, right = width - 12, top = 8, bottom = height - 24;
  const x = (t) => left + ((t - span[0]) / (span[1] - span[0] || 1)) * (right - left);
  const y = (value) => bottom - ((value - low) / (high - low)) * (bottom - top);
  context.clearRect(0, 0, width, height);
  context.font = "13px system-ui, sans-serif";
  context.fillStyle = "#3d4650";
  context.strokeStyle = "#e3e6e9";
  context.lineWidth = 1;
  context.textBaseline = "middle";
  context.textAlign = "right";
  for (const value of ticks(low, high, 4)) {
    context.beginPath(); context.moveTo(left, y(value)); context.lineTo(right, y(value)); context.stroke();
    context.fillText(short(value), left - 6, y(value));
  }
  context.textAlign = "center";
  for (const t of ticks(span[0], span[1], Math.max(2, width / 110))) context.fillText(`${short(t)} s`, x(t), bottom + 13);
  context.beginPath();
  let begun = false;
  curve.values.forEach((value, k) => {
    if (value === null) { begun = false; return; }
    if (begun) context.lineTo(x(curve.time[k]), y(value)); else context.moveTo(x(curve.time[k]), y(value));
    begun = true;
  });
  context.strokeStyle = "#1f5f99";
  context.lineWidth = 1.6;
  context.stroke();
  context.beginPath();
  context.moveTo(x(time), top); context.lineTo(x(time), bottom);
  context.strokeStyle = "#c0392b";
  context.lineWidth = 1.5;
  context.stroke();
  return { left, right };
}

// A canvas as sharp as the screen: its context, width and height in pixels of the page.
function fitted(canvas) {
  const dense = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * dense)) canvas.width = Math.round(width * dense);
  if (canvas.height !== Math.round(height * dense)) canvas.height = Math.round(height * dense);
  const context = canvas.getContext("2d");
  context.setTransform(dense, 0, 0, dense, 0, 0);
  return [context, width, height];
}
