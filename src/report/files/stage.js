// The picture: sheet, lines and outlines of one shape, camera and light. Positions are in mm, relative to the
// data's origin.

const kSides = 6;  // of a tube
const kBesideFrom = 560;  // width of the canvas from which two pictures stand beside each other [px]

// Unique edges of triangles, as pairs of nodes.
function edgesOf(triangles) {
  const seen = new Set(), pairs = [];
  for (let t = 0; t < triangles.length; t += 3)
    for (let k = 0; k < 3; ++k) {
      const a = triangles[t + k], b = triangles[t + (k + 1) % 3], low = Math.min(a, b), high = Math.max(a, b);
      const code = low * 67108864 + high;
      if (seen.has(code)) continue;
      seen.add(code);
      pairs.push(low, high);
    }
  return Uint32Array.from(pairs);
}

// Every triangle has corners of its own, so that each can have its colour.
function makeSheet(triangles, material) {
  const geometry = new THREE.BufferGeometry(), size = 3 * triangles.length;
  for (const name of ["position", "normal", "color"])
    geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(size), 3));
  const mesh = new THREE.Mesh(geometry, material);
  const array = name => geometry.attributes[name].array;

  mesh.place = nodes => {
    const sums = new Float32Array(nodes.length), at = array("position"), normals = array("normal");
    for (let c = 0; c < triangles.length; ++c) at.set(nodes.subarray(3 * triangles[c], 3 * triangles[c] + 3), 3 * c);
    for (let t = 0; t < at.length; t += 9) {
      const u = [0, 1, 2].map(k => at[t + 3 + k] - at[t + k]), v = [0, 1, 2].map(k => at[t + 6 + k] - at[t + k]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      for (let c = 0; c < 3; ++c)
        for (let k = 0; k < 3; ++k) sums[3 * triangles[t / 3 + c] + k] += n[k];
    }
    for (let c = 0; c < triangles.length; ++c) {
      const n = sums.subarray(3 * triangles[c], 3 * triangles[c] + 3), length = Math.hypot(...n) || 1;
      for (let k = 0; k < 3; ++k) normals[3 * c + k] = n[k] / length;
    }
    geometry.attributes.position.needsUpdate = geometry.attributes.normal.needsUpdate = true;
    geometry.computeBoundingSphere();
  };

  // shade(corner, triangle): red, green, blue of a corner
  mesh.paint = shade => {
    const colours = array("color");
    for (let c = 0; c < triangles.length; ++c) colours.set(shade(triangles[c], Math.floor(c / 3)), 3 * c);
    geometry.attributes.color.needsUpdate = true;
  };
  return mesh;
}

// Straight tubes; one for each pair of ends.
function makeTubes(count, radius, material) {
  const geometry = new THREE.BufferGeometry(), index = [];
  for (const name of ["position", "normal", "color"])
    geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(6 * kSides * count), 3));
  for (let s = 0; s < count; ++s)
    for (let k = 0; k < kSides; ++k) {
      const a = 2 * kSides * s + k, b = 2 * kSides * s + (k + 1) % kSides;
      index.push(a, b, a + kSides, b, b + kSides, a + kSides);
    }
  geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(index), 1));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.trianglesPerTube = 2 * kSides;

  // ends(s): two points as arrays of three
  mesh.place = ends => {
    const at = geometry.attributes.position.array, normals = geometry.attributes.normal.array;
    const axis = new THREE.Vector3(), side = new THREE.Vector3(), other = new THREE.Vector3();
    for (let s = 0; s < count; ++s) {
      const [from, to] = ends(s);
      axis.set(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
      if (axis.lengthSq() === 0) axis.set(0, 0, 1);
      axis.normalize();
      side.set(1, 0, 0);
      if (Math.abs(axis.x) > 0.8) side.set(0, 1, 0);
      side.cross(axis).normalize();
      other.crossVectors(axis, side);
      for (let k = 0; k < 2 * kSides; ++k) {
        const angle = 2 * Math.PI * (k % kSides) / kSides, end = k < kSides ? from : to;
        const place = 3 * (2 * kSides * s + k);
        for (let c = 0; c < 3; ++c) {
          const normal = Math.cos(angle) * side.getComponent(c) + Math.sin(angle) * other.getComponent(c);
          normals[place + c] = normal;
          at[place + c] = end[c] + radius * normal;
        }
      }
    }
    geometry.attributes.position.needsUpdate = geometry.attributes.normal.needsUpdate = true;
    geometry.computeBoundingSphere();
  };

  mesh.paint = shade => {
    const colours = geometry.attributes.color.array;
    for (let s = 0; s < count; ++s)
      for (let k = 0; k < 2 * kSides; ++k) colours.set(shade(s), 3 * (2 * kSides * s + k));
    geometry.attributes.color.needsUpdate = true;
  };
  return mesh;
}

function makeEdges(triangles) {
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(edgesOf(triangles), 1));
  const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ transparent: true, opacity: 0.3 }));
  lines.place = nodes => {
    geometry.setAttribute("position", new THREE.BufferAttribute(nodes, 3));
    geometry.computeBoundingSphere();
  };
  return lines;
}

// Box around all shapes: centre and half the diagonal.
function boundsOf(states) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const nodes of states)
    for (let i = 0; i < nodes.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], nodes[i]);
      high[i % 3] = Math.max(high[i % 3], nodes[i]);
    }
  return { centre: low.map((v, k) => (v + high[k]) / 2),
           radius: Math.hypot(...high.map((v, k) => v - low[k])) / 2 || 1 };
}

// From where a camera that looks along -z sees all shapes: what lies in the middle of them across its sight, and the
// distance from there. axes: x, y, z of the camera; slopes: of the edges of its picture, across and upwards.
function fitted(states, centre, axes, slopes) {
  const each = visit => {
    for (const nodes of states)
      for (let i = 0; i < nodes.length; i += 3)
        visit(...axes.map(axis => axis.x * (nodes[i] - centre.x) + axis.y * (nodes[i + 1] - centre.y) + axis.z * (nodes[i + 2] - centre.z)));
  };
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  each((...place) => [0, 1].forEach(k => {
    low[k] = Math.min(low[k], place[k]);
    high[k] = Math.max(high[k], place[k]);
  }));
  const middle = [0, 1].map(k => (low[k] + high[k]) / 2);
  let distance = 0;
  each((x, y, z) => distance = Math.max(distance, z + Math.abs(x - middle[0]) / slopes[0], z + Math.abs(y - middle[1]) / slopes[1]));
  return { middle, distance };
}

// Renderer, camera and controls. frame: unit vectors right and up in the view from above, and towards its viewer.
function makeStage(canvas, frame, bounds, states) {
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
  renderer.setClearColor(0, 0);
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(32, 1, bounds.radius / 100, bounds.radius * 40);
  const vector = values => new THREE.Vector3(...values);
  const centre = vector(bounds.centre), [right, up, towards] = ["right", "up", "towards"].map(key => vector(frame[key]));
  camera.up.copy(towards);
  scene.add(new THREE.HemisphereLight(0xffffff, 0xe6e6ee, 0.72));
  const lamp = new THREE.DirectionalLight(0xffffff, 0.38);
  lamp.position.set(-0.4, 0.5, 1);
  camera.add(lamp);
  scene.add(camera);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;
  controls.enableZoom = false;  // the wheel belongs to the page until the picture is chosen
  // Pictures by the one camera, beside each other or, where the canvas is narrow, below; each is made ready and drawn.
  let panes = [() => {}];
  const paneSize = () => {
    const width = canvas.clientWidth, height = canvas.clientHeight, isBeside = width >= kBesideFrom;
    return { isBeside, width: isBeside ? width / panes.length : width, height: isBeside ? height : height / panes.length };
  };
  const draw = () => {
    const { isBeside, width, height } = paneSize();
    renderer.setScissorTest(panes.length > 1);
    panes.forEach((ready, k) => {
      const box = isBeside ? [k * width, 0, width, height] : [0, (panes.length - 1 - k) * height, width, height];
      ready();
      renderer.setViewport(...box);
      renderer.setScissor(...box);
      renderer.render(scene, camera);
    });
  };
  // Which picture lies under a place of the window, and where in it, from -1 to 1 each way.
  const paneAt = (x, y) => {
    const box = canvas.getBoundingClientRect(), { isBeside, width, height } = paneSize();
    const across = (x - box.left) / width, down = (y - box.top) / height;
    const pane = clamp(Math.floor(isBeside ? across : down), 0, panes.length - 1);
    return { pane, at: { x: 2 * (across - (isBeside ? pane : 0)) - 1, y: 1 - 2 * (down - (isBeside ? 0 : pane)) } };
  };
  controls.addEventListener("change", draw);
  canvas.addEventListener("focus", () => controls.enableZoom = true);
  canvas.addEventListener("blur", () => controls.enableZoom = false);

  // The picture keeps all in view, also when its shape changes, until the user moves the camera.
  let lookedFrom = null;
  const look = from => {
    lookedFrom = from;
    const z = from.clone().normalize(), x = camera.up.clone().cross(z).normalize(), y = z.clone().cross(x);
    const slope = 0.93 * Math.tan(camera.fov * Math.PI / 360);
    const { middle, distance } = fitted(states, centre, [x, y, z], [slope * camera.aspect, slope]);
    controls.target.copy(centre).addScaledVector(x, middle[0]).addScaledVector(y, middle[1]);
    camera.position.copy(controls.target).addScaledVector(z, Math.max(distance, 1.5 * bounds.radius));
    controls.update();
    draw();
  };
  controls.addEventListener("start", () => lookedFrom = null);
  const mixed = (r, u, t) => new THREE.Vector3().addScaledVector(right, r).addScaledVector(up, u).addScaledVector(towards, t);
  const views = {
    oblique: () => look(mixed(0.25, -0.75, 0.8)),
    above: () => look(mixed(0, -1e-3, 1)),
    below: () => look(mixed(0, -1e-3, -1)),
    side: () => look(mixed(0, -1, 0.02)),
  };

  // By the keyboard: angles in radians.
  const turn = (around, over, nearer) => {
    lookedFrom = null;
    const upright = new THREE.Quaternion().setFromUnitVectors(camera.up, new THREE.Vector3(0, 1, 0));
    const offset = camera.position.clone().sub(controls.target).applyQuaternion(upright);
    const place = new THREE.Spherical().setFromVector3(offset);
    place.theta += around;
    place.phi = clamp(place.phi + over, 1e-3, Math.PI - 1e-3);
    place.radius = clamp(place.radius * nearer, bounds.radius / 10, bounds.radius * 30);
    offset.setFromSpherical(place).applyQuaternion(upright.inverse());
    camera.position.copy(controls.target).add(offset);
    controls.update();
    draw();
  };

  const resize = () => {
    const width = canvas.clientWidth, height = canvas.clientHeight, pane = paneSize();
    if (width === 0 || height === 0) return;
    renderer.setSize(width, height, false);
    camera.aspect = pane.width / pane.height;
    camera.updateProjectionMatrix();
    if (lookedFrom) look(lookedFrom);
    else draw();
  };
  new ResizeObserver(resize).observe(canvas);
  const setPanes = those => {
    panes = those;
    resize();
  };
  return { renderer, scene, camera, draw, resize, setPanes, paneSize, paneAt, turn, views, vector, right, up, towards, centre };
}
