// The viewer: reads the data of the page, draws them, and answers to the controls.

function readData() {
  const data = JSON.parse(byId("shape-data").textContent);
  const unpacked = values => {  // a number: those of an earlier state
    const read = values.map(each => typeof each === "string" ? floats(each) : each);
    return read.map(each => typeof each === "number" ? read[each] : each);
  };
  for (const name of ["triangles", "lines", "obstacles"]) data[name] = integers(data[name]);
  if (!data.sequences.length) data.sequences = [{ label: "", states: data.states.length }];
  let first = 0;
  for (const way of data.sequences) {
    Object.assign(way, { first, last: first + way.states - 1 });
    for (const state of data.states.slice(first, first += way.states)) state.way = way;
  }
  for (const state of data.states) {
    state.nodes = typeof state.nodes === "number" ? data.states[state.nodes].nodes : floats(state.nodes);
    for (const outline of state.outlines) outline.points = floats(outline.points);
  }
  for (const field of [...data.fields, ...data.line_values]) field.values = unpacked(field.values);
  if (data.pair) addChanges(data);
  if (data.line_force) data.line_force = { ...data.line_force, values: unpacked(data.line_force.values), map: "force" };
  return data;
}

// Of a pair: what has another value in the second shape than in the first, and how far each place has moved.
function addChanges(data) {
  const [before, after] = [data.states[0], data.states[data.states.length - 1]];
  const changes = data.fields.flatMap(field => {
    const [from, to] = [valuesIn(data, field, 0), valuesIn(data, field, data.states.length - 1)];
    if (field.categories || !from || !to || from === to) return [];
    return [{ title: "Change of " + field.title.charAt(0).toLowerCase() + field.title.slice(1), unit: field.unit, at: field.at, isChange: true,
              values: [to.map((value, k) => value - from[k])], none: "no value in one of both" }];
  });
  const count = before.nodes.length / 3;
  const moved = { title: "Distance between both shapes", unit: "mm", at: "vertex",
                  values: [Float32Array.from({ length: count }, (_, n) => Math.hypot(...[0, 1, 2].map(c => after.nodes[3 * n + c] - before.nodes[3 * n + c])))] };
  data.fields.unshift(...changes.splice(0, 1), moved);
  data.fields.push(...changes);
}

function makeViewer() {
  const data = readData(), canvas = byId("canvas");
  const shapes = data.states.map(state => state.nodes), bounds = boundsOf(shapes);
  const stage = makeStage(canvas, data.frame, bounds, shapes);
  const viewer = { data, canvas, bounds, stage, parts: makeParts(data, stage, bounds.radius), wanted: {}, isPair: false,
                   shown: { state: data.states.length - 1, field: data.fields[0], node: -1, triangle: -1 } };
  const twin = data.pair && makeParts(data, stage, bounds.radius);
  if (twin) twin.group.visible = false;

  // What is drawn, from left to right.
  viewer.pictures = () => viewer.isPair
      ? [{ parts: viewer.parts, state: 0 }, { parts: twin, state: data.states.length - 1 }]
      : [{ parts: viewer.parts, state: viewer.shown.state }];

  viewer.redraw = () => {
    for (const { parts, state } of viewer.pictures()) {
      const shown = { ...viewer.shown, state };
      placeParts(parts, data, shown, viewer.wanted);
      paintParts(parts, data, shown);
    }
    stage.draw();
  };

  viewer.standBeside = isPair => {
    viewer.isPair = isPair;
    const groups = viewer.pictures().map(picture => picture.parts.group);
    if (twin) twin.group.visible = false;
    stage.setPanes(groups.map(own => () => groups.forEach(group => group.visible = group === own)));
    if (!isPair) viewer.parts.group.visible = true;
    viewer.redraw();
  };

  viewer.tell = () => {
    const pictures = viewer.pictures(), shown = { ...viewer.shown, state: pictures[pictures.length - 1].state }, box = byId("legends");
    box.textContent = "";
    if (shown.field) addLegend(box, shown.field);
    if (data.line_force && viewer.wanted.chords) addLegend(box, data.line_force);
    byId("carried").hidden = !shown.field || !data.states[shown.state].carried;
    const { carried, way } = data.states[shown.state];  // on the way to a result its own outline is not known
    byId("orifice-text").textContent = data.states[carried ? way.last : shown.state].orifice_text || "orifice outline";
    showValues(data, shown, viewer.isPair ? { ...shown, state: 0 } : null);
    const sentence = spoken(data, shown);
    if (byId("picked").textContent !== sentence) byId("picked").textContent = sentence;
  };

  viewer.show = what => {
    Object.assign(viewer.shown, what);
    viewer.redraw();
    viewer.tell();
  };
  return viewer;
}

function connectSlider({ data, shown, show }) {
  const slider = byId("state"), play = byId("play"), choice = byId("way");
  let timer = 0, way = data.sequences[data.sequences.length - 1];
  const go = state => {
    slider.value = state - way.first;
    slider.setAttribute("aria-valuetext", data.states[state].label);
    byId("state-label").textContent = data.states[state].label;
    show({ state });
  };
  const stop = () => {
    clearInterval(timer);
    timer = 0;
    play.textContent = "Play";
  };
  const take = next => {
    stop();
    const share = way.states > 1 ? (shown.state - way.first) / (way.states - 1) : 1;  // of the way: open stays open
    way = next;
    slider.max = way.states - 1;
    byId("slider").hidden = way.states === 1;
    go(way.first + Math.round(share * (way.states - 1)));
  };
  slider.addEventListener("input", () => {
    stop();
    go(way.first + Number(slider.value));
  });
  play.addEventListener("click", () => {
    if (timer) return stop();
    if (shown.state === way.last) go(way.first);
    play.textContent = "Stop";
    timer = setInterval(() => shown.state === way.last ? stop() : go(shown.state + 1), 350);
  });
  data.sequences.forEach((each, k) => choice.appendChild(element("option", each.label)).value = k);
  choice.value = data.sequences.length - 1;
  choice.addEventListener("change", () => take(data.sequences[choice.value]));
  byId("ways").hidden = data.sequences.length === 1;
  take(way);
}

// Two shapes beside each other, with their names; or one, along the slider.
function connectPair(viewer) {
  const { data, stage, canvas, standBeside, shown, show } = viewer, box = byId("pair"), names = byId("pane-names");
  byId("pair-choice").hidden = !data.pair;
  if (!data.pair) return;
  const label = k => data.states[k].label;
  names.append(element("span", label(0)), element("span", label(data.states.length - 1)));
  const arrange = () => {
    const { isBeside, width, height } = stage.paneSize();
    Object.assign(names.lastChild.style, isBeside ? { left: width + "px", top: 0 } : { left: 0, top: height + "px" });
  };
  const apply = () => {
    byId("viewer").classList.toggle("pair", box.checked);
    byId("slider").hidden = byId("state-label").hidden = box.checked;
    names.hidden = !box.checked;
    standBeside(box.checked);
    arrange();
    show({ state: shown.state });
  };
  new ResizeObserver(arrange).observe(canvas);
  box.addEventListener("change", apply);
  apply();
}

function connectColours({ data, show }) {
  const select = byId("field");
  data.fields.forEach((field, k) => select.appendChild(element("option", field.title)).value = k);
  select.appendChild(element("option", "no colours")).value = -1;
  select.addEventListener("change", () => show({ field: data.fields[select.value] }));
}

function connectSwitches({ data, parts, wanted, show }) {
  const counts = { chords: data.lines.length, edges: data.triangles.length, obstacles: data.obstacles.length,
                   orifice: parts.orifice.children.length, coaptation: parts.coaptation.children.length };
  for (const [name, count] of Object.entries(counts)) {
    const box = byId("show-" + name), apply = () => wanted[name] = box.checked && count > 0;
    box.closest("label").hidden = count === 0;
    box.addEventListener("change", () => {
      apply();
      show({});
    });
    apply();
  }
}

function connectCut({ stage, bounds }) {
  const normals = { towards: stage.towards, right: stage.right, up: stage.up }, slider = byId("cut-at");
  const apply = () => {
    const normal = normals[byId("cut").value], from = Number(slider.value) / 100 * bounds.radius;
    const place = normal ? figure(from, 3) + " mm from the middle" : "";
    slider.disabled = !normal;
    slider.setAttribute("aria-valuetext", place);
    byId("cut-label").textContent = place;
    stage.renderer.clippingPlanes = normal ? [new THREE.Plane(normal.clone().negate(), normal.dot(stage.centre) + from)] : [];
    stage.draw();
  };
  byId("cut").addEventListener("change", apply);
  slider.addEventListener("input", apply);
  apply();
}

function connectPicking({ data, canvas, stage, pictures, show }) {
  const field = byId("node"), count = data.states[0].nodes.length / 3;
  const pickAt = (x, y) => {
    const picked = pickedAt(stage, pictures(), data, x, y) || { node: -1, triangle: -1 };
    field.value = picked.node < 0 ? "" : picked.node;
    show(picked);
  };
  let down = null;
  canvas.addEventListener("pointerdown", event => down = event);
  canvas.addEventListener("pointerup", event => {
    if (down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < 4) pickAt(event.clientX, event.clientY);
    down = null;
  });
  canvas.addEventListener("keydown", event => {
    const box = canvas.getBoundingClientRect();
    if (event.key === "Enter") pickAt(box.left + box.width / 2, box.top + box.height / 2);
  });
  field.max = count - 1;
  byId("node-range").textContent = "0 to " + (count - 1);
  field.addEventListener("input", () => {
    const node = field.value === "" ? -1 : Number(field.value);
    if (Number.isInteger(node) && node >= -1 && node < count) show({ node, triangle: -1 });
  });
}

function connectCamera({ canvas, stage, redraw }) {
  const keys = { ArrowLeft: [-0.1, 0, 1], ArrowRight: [0.1, 0, 1], ArrowUp: [0, -0.1, 1], ArrowDown: [0, 0.1, 1],
                 "+": [0, 0, 0.9], "=": [0, 0, 0.9], "-": [0, 0, 1.1] };
  canvas.addEventListener("keydown", event => {
    if (keys[event.key]) stage.turn(...keys[event.key]);
    else if (event.key === "Home") stage.views.oblique();
    else return;
    event.preventDefault();
  });
  for (const button of document.querySelectorAll("[data-view]"))
    button.addEventListener("click", () => stage.views[button.dataset.view]());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  stage.resize();
  stage.views.oblique();
}

function canDraw() {
  const canvas = document.createElement("canvas");
  return Boolean(canvas.getContext("webgl2") || canvas.getContext("webgl"));
}

if (canDraw()) {
  const viewer = makeViewer();
  for (const connect of [connectSwitches, connectColours, connectCut, connectPicking, connectCamera, connectSlider, connectPair, connectParameters])
    connect(viewer);
  byId("screenshot").addEventListener("click", () => saveScreenshot(viewer.canvas, viewer.data, viewer.shown));
  byId("viewer").dataset.ready = "yes";
} else {
  byId("viewer").hidden = true;
  byId("no-view").hidden = false;
}
