// Legends, and the values at a node, in words.

function addLegend(box, field) {
  const shades = colouring(field), part = box.appendChild(element("div", undefined, "legend"));
  part.appendChild(element("div", field.title + (field.unit ? " [" + field.unit + "]" : ""), "title"));
  if (shades.categories) {
    const list = part.appendChild(element("ul"));
    for (const [name, shade] of shades.categories) {
      const swatch = element("span", undefined, "swatch");
      swatch.style.background = css(shade);
      list.appendChild(element("li")).append(swatch, name);
    }
    return;
  }
  part.appendChild(element("div", undefined, "bar")).style.background =
      "linear-gradient(to right," + shades.map.filter((_, k) => k % 15 === 0).map(css).join(",") + ")";
  const scale = part.appendChild(element("div", undefined, "scale"));
  for (const t of [0, 0.5, 1]) scale.appendChild(element("span", figure(shades.range[0] + t * (shades.range[1] - shades.range[0]), 3)));
  const low = quantile(shades.all, 0), high = quantile(shades.all, 1);
  if (Number.isFinite(low))
    part.appendChild(element("div", "values from " + figure(low, 4) + " to " + withUnit(high, field.unit, 4), "quiet"));
  if (!shades.all.every(Number.isFinite)) part.appendChild(element("div", "grey: " + (field.none || "no value"), "quiet"));
}

// A quantity of triangles is told as the mean of those around the node, a category as that of the picked triangle.
// Null where there is nothing to tell.
function valueAt(data, field, shown) {
  const values = valuesIn(data, field, shown.state);
  if (!values || shown.node < 0) return null;
  if (field.at === "vertex") return shown.node < values.length ? values[shown.node] : null;
  if (field.categories) return shown.triangle >= 0 ? values[shown.triangle] : null;
  let sum = 0, count = 0;
  for (let c = 0; c < data.triangles.length; ++c)
    if (data.triangles[c] === shown.node) sum += values[Math.floor(c / 3)], ++count;
  return count ? sum / count : null;
}

function worded(field, value) {
  if (field.categories) return field.categories[value] ?? "–";
  return Number.isFinite(value) ? withUnit(value, field.unit, 5) : field.none || "–";
}

// In words, those that it has.
function valuesOfLine(data, shown, k) {
  return data.line_values.flatMap(field => {
    const values = valuesIn(data, field, shown.state);
    return values && Number.isFinite(values[k]) ? [field.title + " " + withUnit(values[k], field.unit, 4)] : [];
  });
}

// Pairs of name and value.
function valuesAt(data, shown) {
  if (shown.node < 0) return [];
  const at = nodeOf(data, shown.state, shown.node);
  const rows = [["Position", [0, 1, 2].map(k => (at[k] + data.origin[k]).toFixed(4)).join(", ") + " mm"]];
  for (const field of data.fields) {
    const value = valueAt(data, field, shown), isMean = field.at !== "vertex" && !field.categories;
    if (value !== null) rows.push([field.title + (isMean ? ", mean of the triangles around" : ""), worded(field, value)]);
  }
  const forces = data.line_force && valuesIn(data, data.line_force, shown.state), most = rows.length + 6;
  for (let k = 0; forces && k < data.lines.length / 2 && rows.length < most; ++k)
    if (data.lines[2 * k] === shown.node || data.lines[2 * k + 1] === shown.node)
      rows.push(["Chord or cable " + k, [withUnit(forces[k], data.line_force.unit, 5), ...valuesOfLine(data, shown, k)].join(", ")]);
  return rows;
}

// before: of a pair, the same in its first shape.
function showValues(data, shown, before) {
  const body = byId("values").tBodies[0];
  body.textContent = "";
  const others = new Map(before ? valuesAt(data, before) : []);
  for (const [name, value] of valuesAt(data, shown)) {
    const row = body.appendChild(element("tr")), other = others.get(name);
    row.appendChild(element("th", name)).scope = "row";
    row.appendChild(element("td", other === undefined || other === value ? value : data.states[before.state].label + ": " + other + "; " + data.states[shown.state].label + ": " + value));
  }
}

// The sentence that screen readers speak.
function spoken(data, shown) {
  if (shown.node < 0) return "Nothing picked.";
  const value = shown.field ? valueAt(data, shown.field, shown) : null;
  return "Node " + shown.node + (shown.triangle >= 0 ? ", triangle " + shown.triangle : "") + "." +
         (value === null ? "" : " " + shown.field.title + ": " + worded(shown.field, value) + ".");
}
