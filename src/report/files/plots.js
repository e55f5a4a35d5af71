"use strict";
// Draws every plot of the page with uPlot, from the JSON in its element .chart. uPlot has scales, grid and pixels; ranges,
// ticks in the numbers of the page, marks, key and tooltip are here.
{
const font = "12px system-ui, sans-serif", markSize = 4.5, reach = 40;  // [px]; reach: how near the pointer finds a point
const dashes = [[], [7, 3], [2, 3], [8, 3, 2, 3]];
const colour = name => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
const make = (name, kind, text = "") => Object.assign(document.createElement(name), { className: kind, textContent: text });

// As page_number() of the library writes it.
function number(value, digits = 4) {
  const size = Math.abs(value);
  if (size < 1e9 && value === Math.round(value)) return String(value);
  if (size < 1e-3 || size >= 1e6) return Number(value.toPrecision(digits - 1)).toExponential();
  return String(Number(value.toPrecision(Math.max(digits, Math.ceil(Math.log10(size))))));
}

// 1, 2 or 5 times a power of ten, the least that is not below the value.
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * [1, 2, 5, 10].find(factor => factor * power >= value * (1 - 1e-9));
}
const roundDown = value => {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * [5, 2, 1].find(factor => factor * power <= value * (1 + 1e-9));
};

// The ends of an axis: round numbers around all values, of a logarithmic one around the positive ones.
function rangeOf(values, axis) {
  if (axis.names) return [0.5, axis.names.length + 0.5];
  const seen = axis.logarithmic ? values.filter(value => value > 0) : values;
  if (seen.length === 0) return [0, 1];
  let low = seen.reduce((a, b) => Math.min(a, b)), high = seen.reduce((a, b) => Math.max(a, b));
  if (axis.logarithmic) {
    const power = value => 10 ** Math.floor(Math.log10(value) + 1e-9);
    return high / low < 1e4 ? [roundDown(low), roundUp(high)] : [power(low), 10 * power(high * (1 - 1e-9))];
  }
  if (!(high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)))) {
    const half = 0.5 * Math.abs(high) || 0.5;
    [low, high] = [low - half, high + half];
  }
  const step = roundUp((high - low) / 8);
  return [step * Math.floor(low / step + 1e-9), step * Math.ceil(high / step - 1e-9)];
}

// Where the ticks of an axis stand, at least `space` pixels apart on its `length`.
function ticksOf(axis, min, max, length, space) {
  const most = Math.max(1, Math.floor(length / space)), ticks = [];
  if (!axis.logarithmic) {
    const least = (max - min) / most;
    const step = axis.names ? Math.max(1, Math.ceil(least)) : Math.max(roundUp(least), axis.isWhole ? 1 : 0);
    for (let k = Math.ceil(min / step - 1e-9); k * step <= max + 1e-9 * step; ++k) ticks.push(k * step);
    return ticks;
  }
  const first = Math.ceil(Math.log10(min) - 1e-9), last = Math.floor(Math.log10(max) + 1e-9);
  const decades = Math.log10(max / min), step = Math.max(1, Math.ceil((last - first + 1) / most));
  const factors = [[1, 2, 5], [1, 3]].find(those => those.length * decades <= most) ?? [1];
  for (let k = factors.length > 1 ? first - 1 : first; k <= last; k += factors.length > 1 ? 1 : step)
    for (const factor of factors) {
      const tick = Number(factor + "e" + k);
      if (tick >= min * (1 - 1e-9) && tick <= max * (1 + 1e-9)) ticks.push(tick);
    }
  return ticks;
}

// Very large and very small numbers have their power of ten with its exponent set high: 0.01, 10⁻⁶, 2.5·10⁻⁶.
function tickText(axis, value, range) {
  if (axis.names) return axis.names[Math.round(value) - 1] ?? "";
  // A linear axis has a tick of 1e-17 where zero is meant; on a logarithmic one small decades are what they are.
  if (!axis.logarithmic && Math.abs(value) < 1e-9 * range) return "0";
  const size = Math.abs(value), isPlain = axis.logarithmic ? size >= 1e-3 * (1 - 1e-9) && size < 5000 : size >= 1e-4 && size < 1e6;
  if (isPlain) return String(Number(value.toPrecision(6)));
  const [factor, exponent] = Number(value.toPrecision(6)).toExponential().split("e");
  const high = [...exponent].map(digit => digit === "+" ? "" : digit === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]).join("");
  return (factor === "1" ? "" : factor + "·") + "10" + high;
}

// A shape for each series, so that colour is not all that tells them apart. r [canvas px].
function shapePath(shape, x, y, r) {
  const path = new Path2D();
  const corners = [null, [[-.9, -.9], [.9, -.9], [.9, .9], [-.9, .9]], [[0, -1.25], [1.1, .8], [-1.1, .8]],
                   [[0, -1.3], [1.3, 0], [0, 1.3], [-1.3, 0]]][shape % 4];
  if (!corners) path.arc(x, y, r, 0, 2 * Math.PI);
  else corners.forEach(([dx, dy]) => path.lineTo(x + r * dx, y + r * dy));
  path.closePath();
  return path;
}

// kind: "" filled; "crossed" hollow and crossed; "edge" an open triangle: the value has no place on the scale.
function drawMark(pen, kind, shape, shade, x, y, ratio) {
  const r = markSize * ratio;
  pen.setLineDash([]);
  pen.lineWidth = (kind ? 1.6 : 1) * ratio;
  pen.fillStyle = kind ? colour("ground") : shade;
  pen.strokeStyle = kind ? shade : colour("ground");
  const path = kind === "edge" ? new Path2D(`M${x - r} ${y - 1.8 * r}h${2 * r}l${-r} ${1.6 * r}z`) : shapePath(shape, x, y, r);
  pen.fill(path);
  pen.stroke(path);
  if (kind !== "crossed") return;
  const d = 1.5 * r;
  pen.stroke(new Path2D(`M${x - d} ${y - d}l${2 * d} ${2 * d}M${x - d} ${y + d}l${2 * d} ${-2 * d}`));
}

function drawLine(pen, from, to, shade, dash, ratio) {
  Object.assign(pen, { strokeStyle: shade, lineWidth: ratio });
  pen.setLineDash(dash.map(length => length * ratio));
  pen.stroke(new Path2D(`M${from.join(" ")}L${to.join(" ")}`));
}

// What an element of the key shows, drawn as the plot draws it.
function drawSample(canvas, series) {
  const ratio = devicePixelRatio, pen = canvas.getContext("2d");
  [canvas.width, canvas.height] = [26 * ratio, 14 * ratio];
  const shade = colour(series.colour === undefined ? "quiet" : "s" + series.colour), middle = [13 * ratio, 7 * ratio];
  if (series.isRound) return drawLine(pen, [middle[0], 0], [middle[0], 14 * ratio], shade, [1, 3], ratio);
  if (series.joined) drawLine(pen, [0, middle[1]], [26 * ratio, middle[1]], shade, dashes[series.dashes], 1.8 * ratio);
  drawMark(pen, series.kind ?? "", series.shape ?? 0, shade, ...middle, 0.9 * ratio);
}

function keyOf(data) {
  const key = make("ul", "key"), entries = [...data.series];
  const has = name => data.series.some(series => series[name].length > 0);
  if (has("crossed")) entries.push({ name: data.crossed_text, kind: "crossed" });
  if (has("rounds")) entries.push({ name: "another energy from here on", isRound: true });
  const samples = entries.map(entry => {
    const item = make("li", ""), canvas = make("canvas", "");
    canvas.setAttribute("aria-hidden", "true");
    item.append(canvas, entry.name);
    key.append(item);
    return () => drawSample(canvas, entry);
  });
  return { key, draw: () => samples.forEach(sample => sample()) };
}

// Marks of one series, on top of its line.
function drawMarks(plot, series, ratio) {
  const crossed = new Set(series.crossed), pen = plot.ctx, shade = colour("s" + series.colour);
  series.x.forEach((x, k) => {
    const kind = crossed.has(k) ? "crossed" : series.isOffScale[k] ? "edge" : "";
    if (series.marks || kind)
      drawMark(pen, kind, series.shape, shade, plot.valToPos(series.px[k], "x", true), plot.valToPos(series.py[k], "y", true), ratio);
  });
}

// Dotted upright lines where another function is minimised, dashed ones at levels of y: below the series.
function drawGuides(plot, data, ratio) {
  const { left, top, width, height } = plot.bbox, pen = plot.ctx;
  for (const series of data.series)
    for (const k of series.rounds) {
      const x = plot.valToPos(series.px[k], "x", true);
      drawLine(pen, [x, top], [x, top + height], colour("quiet"), [1, 3], ratio);
    }
  for (const level of data.levels) {
    if (data.y.logarithmic && !(level.y > 0)) continue;
    const y = plot.valToPos(level.y, "y", true);
    drawLine(pen, [left, y], [left + width, y], colour("ink"), [5, 4], ratio);
  }
}

// The names of the levels, above the series, each with a rim in which no line hides it.
function drawLevelNames(plot, data, ratio) {
  const pen = plot.ctx, right = plot.bbox.left + plot.bbox.width - 6 * ratio;
  Object.assign(pen, { fillStyle: colour("ink"), strokeStyle: colour("ground"), lineWidth: 4 * ratio, lineJoin: "round",
                       font: 12 * ratio + font.slice(2), textAlign: "right", textBaseline: "bottom" });
  pen.setLineDash([]);
  for (const level of data.levels) {
    if (data.y.logarithmic && !(level.y > 0)) continue;
    const y = plot.valToPos(level.y, "y", true) - 3 * ratio;
    pen.strokeText(level.label, right, y);
    pen.fillText(level.label, right, y);
  }
}

// Texts of ticks, names cut to what stands between one and the next.
function tickTexts(plot, axis, ticks, range) {
  const texts = ticks.map(tick => tickText(axis, tick, range));
  if (!axis.names) return texts;
  const room = plot.bbox.width / texts.length - 12 * uPlot.pxRatio, fits = text => plot.ctx.measureText(text).width <= room;
  plot.ctx.font = 12 * uPlot.pxRatio + font.slice(2);
  return texts.map(text => {
    let kept = text;
    while (kept && !fits(kept === text ? kept : kept + "…")) kept = kept.slice(0, -1);
    return kept === text ? kept : kept + "…";
  });
}

function axisOf(scale, axis) {
  const isUpright = scale === "y";
  return {
    scale, font, stroke: () => colour("quiet"), gap: 6, labelSize: 0,
    grid: { stroke: () => colour("rule"), width: 1 }, ticks: { show: false },
    splits: (plot, _, min, max) => ticksOf(axis, min, max, (isUpright ? plot.bbox.height : plot.bbox.width) / uPlot.pxRatio,
                                           isUpright ? 34 : axis.names ? 90 : 62),
    filter: (_, splits) => splits,
    values: (plot, splits) => tickTexts(plot, axis, splits, plot.scales[scale].max - plot.scales[scale].min),
    size: (plot, texts) => {
      if (!isUpright) return 26;
      plot.ctx.font = 12 * uPlot.pxRatio + font.slice(2);
      return 10 + Math.max(14, ...(texts ?? []).map(text => plot.ctx.measureText(text).width / uPlot.pxRatio));
    },
  };
}

// The point nearest to a place of the plot [px], or null.
function nearest(plot, data, left, top) {
  let found = null, least = reach;
  for (const series of data.series)
    series.x.forEach((_, k) => {
      const x = plot.valToPos(series.px[k], "x"), y = plot.valToPos(series.py[k], "y"), away = Math.hypot(x - left, y - top);
      if (away < least) [least, found] = [away, { series, k, x, y }];
    });
  return found;
}

function pointText(data, { series, k }) {
  const x = data.x.names ? data.x.names[Math.round(series.x[k]) - 1] : number(series.x[k]);
  const label = series.labels[k] ? ", " + series.labels[k] : "";
  return `${series.name}${label}: ${data.x.title} ${x}, ${data.y.title} ${number(series.y[k])}` +
      (series.crossed.includes(k) ? ` (${data.crossed_text})` : "");
}

function addTooltip(plot, data) {
  const tip = make("div", "tip"), ring = make("div", "ring"), over = plot.over;
  tip.hidden = ring.hidden = true;
  over.append(ring, tip);
  const show = event => {
    const box = over.getBoundingClientRect(), point = nearest(plot, data, event.clientX - box.left, event.clientY - box.top);
    tip.hidden = ring.hidden = !point;
    if (!point) return;
    tip.textContent = pointText(data, point);
    ring.style.translate = `${point.x}px ${point.y}px`;
    const left = Math.min(Math.max(point.x - tip.offsetWidth / 2, 0), box.width - tip.offsetWidth);
    const above = point.y - tip.offsetHeight - 10;
    tip.style.translate = `${left}px ${above < 0 ? point.y + 12 : above}px`;
  };
  over.addEventListener("pointermove", show);
  over.addEventListener("pointerdown", show);
  over.addEventListener("pointerleave", () => tip.hidden = ring.hidden = true);
}

// Puts the points where the scales have a place for them.
function place(data, ranges) {
  for (const series of data.series) {
    const isOff = (axis, value) => axis.logarithmic && !(value > 0);
    series.isOffScale = series.x.map((x, k) => isOff(data.x, x) || isOff(data.y, series.y[k]));
    series.px = series.x.map(x => isOff(data.x, x) ? ranges.x[0] : x);
    series.py = series.y.map(y => isOff(data.y, y) ? ranges.y[0] : y);
  }
}

// The line of a series, in the order of its points.
function linePath(plot, series) {
  const stroke = new Path2D();
  if (series.joined) series.px.forEach((x, k) => stroke.lineTo(plot.valToPos(x, "x", true), plot.valToPos(series.py[k], "y", true)));
  return { stroke, fill: null, clip: null, band: null, gaps: null, flags: 0 };
}

function draw(chart) {
  const data = JSON.parse(chart.querySelector("script").textContent);
  const values = name => data.series.flatMap(series => series[name]);
  const ranges = { x: rangeOf(values("x"), data.x), y: rangeOf([...values("y"), ...data.levels.map(level => level.y)], data.y) };
  for (const name of ["x", "y"]) data[name].isWhole = values(name).every(Number.isInteger);
  place(data, ranges);
  const scaleOf = name => ({ time: false, auto: false, range: () => ranges[name], distr: data[name].logarithmic ? 3 : 1 });
  const frame = make("div", "frame");
  chart.append(make("div", "axis", data.y.title), frame, make("div", "axis under", data.x.title));
  const isPrinted = () => matchMedia("print").matches;
  const size = () => {
    const width = Math.min(frame.clientWidth, isPrinted() ? 640 : Infinity);
    return { width, height: Math.round(Math.min(Math.max(0.55 * width, 240), 380)) };
  };
  const plot = new uPlot({
    ...size(), mode: 2, padding: [8, 24, 0, 0], legend: { show: false }, cursor: { show: false },
    scales: { x: scaleOf("x"), y: scaleOf("y") }, axes: [axisOf("x", data.x), axisOf("y", data.y)],
    series: [null, ...data.series.map(series => ({
      facets: [{ scale: "x", auto: true }, { scale: "y", auto: true }], stroke: () => colour("s" + series.colour), width: 1.8,
      dash: dashes[series.dashes], points: { show: false }, paths: plot => linePath(plot, series) }))],
    hooks: { drawAxes: [plot => drawGuides(plot, data, uPlot.pxRatio)],
             draw: [plot => data.series.forEach(series => drawMarks(plot, series, uPlot.pxRatio)),
                    plot => drawLevelNames(plot, data, uPlot.pxRatio)] },
  }, [null, ...data.series.map(series => [series.px, series.py])], frame);
  const { key, draw: drawKey } = keyOf(data);
  chart.after(key);
  drawKey();
  addTooltip(plot, data);
  const fit = () => {
    const wanted = size();
    if (wanted.width > 0 && (wanted.width !== plot.width || wanted.height !== plot.height)) plot.setSize(wanted);
  };
  new ResizeObserver(fit).observe(frame);
  const renew = () => {
    fit();
    plot.redraw(false, true);
    drawKey();
  };
  for (const query of ["(prefers-color-scheme: dark)", "print"]) matchMedia(query).addEventListener("change", renew);
}

document.querySelectorAll(".chart").forEach(draw);
}
