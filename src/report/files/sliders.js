// Sliders of parameters. They move the result by its first-order response to each, and its figures along straight lines
// to those of the equilibria at both ends of each range.

const kFollowed = 3;  // nodes that a corner of an outline goes with

// Displacements per unit, in steps of one or two bytes.
function readMotion({ motion, bytes: size, step }) {
  const packed = bytes(motion), steps = size === 1 ? new Int8Array(packed) : new Int16Array(packed);
  return Float32Array.from(steps, value => step * value);
}

// The nearest nodes of each corner, with weights that fall with the square of the distance.
function followersOf(points, nodes) {
  const found = [];
  for (let p = 0; p < points.length; p += 3) {
    const near = [];
    for (let n = 0; n < nodes.length; n += 3) {
      const square = (nodes[n] - points[p]) ** 2 + (nodes[n + 1] - points[p + 1]) ** 2 + (nodes[n + 2] - points[p + 2]) ** 2;
      if (near.length === kFollowed && square >= near[kFollowed - 1].square) continue;
      near.push({ n, square });
      near.sort((a, b) => a.square - b.square).splice(kFollowed);
    }
    const weights = near.map(each => 1 / (each.square + 1e-12)), sum = weights.reduce((a, b) => a + b);
    found.push(near.map((each, k) => [each.n, weights[k] / sum]));
  }
  return found;
}

function makeResponse(data) {
  const state = data.states[data.states.length - 1], given = state.nodes;
  state.nodes = given.slice();  // the start may have the same
  const motions = data.sliders.parameters.map(readMotion), wanted = new Set(data.triangles);
  const sheet = Float32Array.from(given, (value, k) => wanted.has(Math.floor(k / 3)) ? value : Infinity);
  let outlines = null;
  return values => {
    outlines ??= state.outlines.map(outline => ({ outline, given: outline.points.slice(), near: followersOf(outline.points, sheet) }));
    state.nodes.set(given);
    values.forEach((value, p) => {
      if (value !== 0) for (let k = 0; k < given.length; ++k) state.nodes[k] += value * motions[p][k];
    });
    for (const { outline, given: at, near } of outlines)
      near.forEach((nodes, k) => {
        for (let c = 0; c < 3; ++c)
          outline.points[3 * k + c] = at[3 * k + c] + nodes.reduce((sum, [n, w]) => sum + w * (state.nodes[n + c] - given[n + c]), 0);
      });
  };
}

// By how much a figure changes: along a straight line to that of the equilibrium at that end of the range.
function changeOf(parameter, name, value, now) {
  const ends = parameter.figures[name], end = value < 0 ? 0 : 1;
  if (!ends || value === 0 || ends[end] === null) return 0;
  return (ends[end] - now) * value / parameter.range[end];
}

// The distance from a solve that is to be expected: errors grow with the square, and of several parameters at once they
// are no more than this where no two of them help each other.
const errorOf = (parameters, values) => values.reduce((sum, value, p) => {
  const end = value < 0 ? 0 : 1;
  return sum + (value === 0 ? 0 : Math.abs(value / parameters[p].range[end]) * Math.sqrt(parameters[p].errors[end]));
}, 0) ** 2;

const changeText = (value, unit) => (value > 0 ? "+" : value < 0 ? "−" : "") + figure(Math.abs(value), 3) + (unit === "%" || unit === "°" ? "" : " ") + unit;

// Ranges of less than a tenth of the usual change, and parameters whose range nobody looked for.
function rangesText({ parameters, left_out: leftOut }) {
  const narrow = parameters.filter(({ range, usual }) => Math.max(...range.map(Math.abs)) < usual / 10).length;
  return (narrow === 0 ? "" : ` ${narrow === 1 ? "One range is" : narrow + " ranges are"} narrow: contacts, folds, or chords between slack and taut change near by, beyond which another straight line holds.`) +
      (leftOut === 0 ? "" : ` Ranges were looked for within half the time of the solve: ${leftOut} more wait for coapt solve --sliders.`);
}

function noteText(sliders, values) {
  const { parameters, candidates } = sliders;
  const moved = values.filter(value => value !== 0).length, error = figure(errorOf(parameters, values), 2) + " mm";
  if (moved === 0)
    return `The ${parameters.length} of ${candidates} parameters that move the sheet most. At both ends of each range, of one at a time, the equilibrium has the sheet within ` +
        figure(Math.max(...parameters.flatMap(parameter => parameter.errors)), 2) + " mm of its first-order place; figures lie on straight lines to those there." + rangesText(sliders);
  if (moved === 1) return "First order: within about " + error + " of a solve. Colours and outlines are those of the result, carried along with the sheet.";
  return "First order of several at once, which nobody has checked: about " + error + " from one. Colours and outlines are carried along.";
}

function showFigures(sliders, values) {
  const isMoved = values.some(value => value !== 0);
  for (const tile of document.querySelectorAll("[data-figure]")) {
    const place = tile.querySelector("[data-value]"), now = Number(tile.dataset.exact), name = tile.dataset.figure;
    place.dataset.given ??= place.textContent;
    const isChanged = isMoved && sliders.parameters.some(parameter => parameter.figures[name]);
    tile.classList.toggle("moved", isChanged);
    tile.classList.toggle("still", isMoved && !isChanged);
    let then = sliders.parameters.reduce((sum, parameter, p) => sum + changeOf(parameter, name, values[p], now), now);
    if (now >= 0) then = Math.max(0, then);
    place.textContent = isChanged ? "≈ " + figure(then, 3) : place.dataset.given;
  }
}

function sliderRow(parameter, k) {
  const label = element("label", parameter.name), input = element("input"), text = element("span", changeText(0, parameter.unit), "change");
  label.htmlFor = input.id = "parameter-" + k;
  Object.assign(input, { type: "range", min: parameter.range[0], max: parameter.range[1], step: "any", value: 0 });
  return { label, input, text };
}

function connectParameters({ data, parts, show }) {
  const { sliders } = data;
  byId("what-if").hidden = !sliders;
  if (!sliders) return;
  if (sliders.parameters.length === 0) {
    byId("what-if-note").textContent = "No sliders of parameters: " + sliders.message + ".";
    byId("what-if-reset").hidden = true;
    return;
  }
  const rows = sliders.parameters.map(sliderRow), values = rows.map(() => 0), last = data.states.length - 1;
  const outline = data.states[last].orifice_text;
  const respond = makeResponse(data), note = byId("what-if-note");
  const apply = () => {
    respond(values);
    for (const group of [parts.orifice, parts.coaptation]) for (const tubes of group.children) tubes.follow();
    byId("state").value = byId("state").max;
    byId("state").dispatchEvent(new Event("input"));
    rows.forEach(({ input, text }, k) => {
      text.textContent = changeText(values[k], sliders.parameters[k].unit);
      input.setAttribute("aria-valuetext", text.textContent);
    });
    showFigures(sliders, values);
    note.textContent = noteText(sliders, values);
    data.states[last].orifice_text = values.some(value => value !== 0) ? "orifice outline, carried along" : outline;
    show({ state: last });
  };
  rows.forEach(({ label, input, text }, k) => {
    byId("what-if-rows").append(label, input, text);
    input.addEventListener("input", () => {
      const { range } = sliders.parameters[k], size = Math.max(...range.map(Math.abs));
      values[k] = Math.abs(Number(input.value)) < size / 150 ? 0 : clamp(Number(input.value), ...range);
      apply();
    });
  });
  byId("what-if-reset").addEventListener("click", () => {
    rows.forEach(({ input }, k) => input.value = values[k] = 0);
    apply();
  });
  note.textContent = noteText(sliders, values);
}
