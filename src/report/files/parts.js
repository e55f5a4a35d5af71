// What is drawn of the data: the sheet and what goes with it, placed and painted for what is shown.
// shown: {state, field, node, triangle}, numbers from 0, -1 for none.

// On the way they are those that it ends with.
function valuesIn(data, field, state) {
  const { carried, way } = data.states[state];
  return field.values.length === 1 ? field.values[0] : field.values[carried ? way.last : state];
}

const nodeOf = (data, state, i) => data.states[state].nodes.subarray(3 * i, 3 * i + 3);

function makeOutlines(data, kind, radius) {
  const group = new THREE.Group();
  for (const state of data.states) for (const outline of state.outlines.filter(each => each.kind === kind)) {
    const isClosed = kind === "orifice", corner = k => outline.points.subarray(3 * k, 3 * k + 3);
    // Corners nearer to each other than the tube is thick would show its ends.
    const kept = [0];
    for (let k = 1; k < outline.points.length / 3; ++k)
      if (Math.hypot(...[0, 1, 2].map(c => corner(k)[c] - corner(kept[kept.length - 1])[c])) >= 2 * radius) kept.push(k);
    const count = kept.length, point = k => corner(kept[k % count]);
    const tubes = makeTubes(isClosed ? count : count - 1, radius, new THREE.MeshBasicMaterial({
      vertexColors: THREE.VertexColors, depthTest: false, transparent: true }));
    tubes.state = state;
    tubes.renderOrder = 1;  // seen through the sheet
    tubes.follow = () => tubes.place(k => [point(k), point(k + 1)]);
    tubes.follow();
    group.add(tubes);
  }
  return group;
}

function makeParts(data, stage, radius) {
  const parts = {
    sheet: makeSheet(data.triangles, new THREE.MeshLambertMaterial({
      vertexColors: THREE.VertexColors, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 })),
    edges: makeEdges(data.triangles),
    chords: makeTubes(data.lines.length / 2, 0.0042 * radius, new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors })),
    obstacles: makeSheet(data.obstacles, new THREE.MeshLambertMaterial({
      color: 0x9aa7b2, side: THREE.DoubleSide, transparent: true, opacity: 0.35, depthWrite: false })),
    orifice: makeOutlines(data, "orifice", 0.006 * radius),
    coaptation: makeOutlines(data, "coaptation", 0.006 * radius),
    marker: new THREE.Mesh(new THREE.SphereGeometry(0.016 * radius, 20, 14),
                           new THREE.MeshBasicMaterial({ color: 0xff3b8d, depthTest: false, transparent: true })),
  };
  parts.marker.renderOrder = 2;
  const group = new THREE.Group();
  for (const part of Object.values(parts)) group.add(part);
  stage.scene.add(group);
  return { ...parts, group };
}

function placeParts(parts, data, shown, wanted) {
  const state = data.states[shown.state], nodes = state.nodes;
  const at = i => nodeOf(data, shown.state, i);
  for (const name of ["sheet", "edges", "obstacles"]) parts[name].place(nodes);
  parts.chords.place(k => [at(data.lines[2 * k]), at(data.lines[2 * k + 1])]);
  for (const name of Object.keys(wanted)) parts[name].visible = wanted[name];
  for (const name of ["orifice", "coaptation"])
    for (const tubes of parts[name].children) tubes.visible = tubes.state === state;
  parts.marker.visible = shown.node >= 0;
  if (shown.node >= 0) parts.marker.position.set(...at(shown.node));
}

function paintParts(parts, data, shown) {
  const field = shown.field, values = field && valuesIn(data, field, shown.state), shades = field && colouring(field);
  parts.sheet.paint((node, triangle) => shades ? shades.of(values ? values[field.at === "vertex" ? node : triangle] : NaN) : kNone);
  const forces = data.line_force && valuesIn(data, data.line_force, shown.state);
  const forceShades = forces && colouring(data.line_force);
  parts.chords.paint(k => forces ? forceShades.of(forces[k]) : kNone);
  const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
  for (const tubes of parts.orifice.children) tubes.paint(() => isDark ? [1, 0.35, 0.6] : [0.84, 0.05, 0.35]);
  for (const tubes of parts.coaptation.children) tubes.paint(() => isDark ? [0.95, 0.95, 0.97] : [0.05, 0.05, 0.08]);
  parts.edges.material.color.set(0x000000);
  parts.edges.material.opacity = isDark ? 0.45 : 0.28;
}

// What lies under a place of the window: the nearest node, and the triangle if it is one of the sheet; null beside
// everything. pictures: parts and state of each.
function pickedAt(stage, pictures, data, x, y) {
  const { pane, at } = stage.paneAt(x, y), { parts, state } = pictures[pane], ray = new THREE.Raycaster();
  ray.setFromCamera(at, stage.camera);
  const isKept = hit => stage.renderer.clippingPlanes.every(plane => plane.distanceToPoint(hit.point) >= 0);
  const hit = ray.intersectObjects([parts.sheet, parts.chords].filter(part => part.visible)).find(isKept);
  if (!hit) return null;
  const onSheet = hit.object === parts.sheet;
  const k = onSheet ? hit.faceIndex : Math.floor(hit.faceIndex / parts.chords.trianglesPerTube);
  const corners = onSheet ? data.triangles.subarray(3 * k, 3 * k + 3) : data.lines.subarray(2 * k, 2 * k + 2);
  const away = node => hit.point.distanceTo(new THREE.Vector3(...nodeOf(data, state, node)));
  return { node: Array.from(corners).sort((a, b) => away(a) - away(b))[0], triangle: onSheet ? k : -1 };
}
