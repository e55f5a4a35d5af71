// What the viewer is made of: data out of the page, numbers as people read them, colours.

const byId = id => document.getElementById(id);

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

// --- data: base64 of little-endian numbers

const bytes = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0)).buffer;
const floats = text => new Float32Array(bytes(text));
const integers = text => new Uint32Array(bytes(text));

// --- numbers

function figure(value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(Math.max(0, digits - 2));
  return String(Number(value.toPrecision(digits)));
}

const withUnit = (value, unit, digits) => figure(value, digits) + (unit && Number.isFinite(value) ? " " + unit : "");

// The value below which a share of the finite ones lies.
function quantile(values, share) {
  const sorted = Float32Array.from(values).filter(Number.isFinite).sort();
  return sorted.length ? sorted[Math.round(share * (sorted.length - 1))] : NaN;
}

// --- elements

function element(name, text, className) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}

// --- colours, in OKLab: B. Ottosson, "A perceptual color space for image processing", 2020. Along each map
// lightness is linear in the value, so equal steps look equal, in grey too.

// L lightness 0 to 1, C chroma, h hue in degrees -> red, green, blue as stored by screens, unclipped.
function fromOklch(L, C, h) {
  const a = C * Math.cos(h * Math.PI / 180), b = C * Math.sin(h * Math.PI / 180);
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.2914855480 * b) ** 3;
  return [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s]
      .map(v => v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
}

// The same with as much of the chroma as a screen can show.
function colour(L, chroma, h) {
  const isShown = C => fromOklch(L, C, h).every(v => v >= -1e-4 && v <= 1 + 1e-4);
  let low = 0, high = chroma;
  if (!isShown(chroma))
    for (let k = 0; k < 20; ++k) isShown((low + high) / 2) ? low = (low + high) / 2 : high = (low + high) / 2;
  else
    low = chroma;
  return fromOklch(L, low, h).map(v => clamp(v, 0, 1));
}

const kShades = 256;
const shadesOf = at => Array.from({ length: kShades }, (_, k) => at(k / (kShades - 1)));

const maps = {
  sequential: shadesOf(t => colour(0.32 + 0.62 * t, 0.145, 295 - 195 * t)),
  reversed: shadesOf(t => colour(0.94 - 0.62 * t, 0.145, 100 + 195 * t)),
  diverging: shadesOf(t => colour(0.96 - 0.56 * Math.abs(2 * t - 1), 0.17 * Math.abs(2 * t - 1), t < 0.5 ? 250 : 40)),
  force: shadesOf(t => colour(0.80 - 0.30 * t, 0.16, 100 - 75 * t)),
};

const kNone = colour(0.72, 0.008, 250);  // where a quantity has no value
const categoryColour = k => colour(0.74 - 0.06 * (Math.floor(k / 6) % 3), 0.12, 235 + 137.5 * k);
const css = rgb => `rgb(${rgb.map(v => Math.round(255 * v)).join(",")})`;

// Ends for a legend: round, and around nearly all values; what lies beyond gets the colour of the end.
function legendRange(values, isDiverging) {
  let low = quantile(values, 0.005), high = quantile(values, 0.995);
  if (isDiverging) high = Math.max(-low, high), low = -high;
  if (!(high > low)) return Number.isFinite(high) ? [Math.min(0, high), Math.max(high, low + 1e-9, 0) || 1] : [0, 1];
  const power = 10 ** Math.floor(Math.log10(high - low)), step = power / 10;
  const rounded = [Math.floor(low / step + 1e-6) * step, Math.ceil(high / step - 1e-6) * step];
  if (low >= 0 && low < 0.25 * high) rounded[0] = 0;
  return rounded;
}

// How the values of a field become colours; worked out once.
const colouring = field => field.shades ??= makeColouring(field);

function makeColouring(field) {
  if (field.categories) {
    return { categories: field.categories.map((name, k) => [name, categoryColour(k)]),
             of: value => Number.isFinite(value) ? categoryColour(value) : kNone };
  }
  const all = field.values.flatMap(values => values ? Array.from(values) : []);
  const low = quantile(all, 0.01), high = quantile(all, 0.99);
  // Of a change zero is always seen, also where nearly all of it has one sign.
  const isDiverging = field.isChange || (low < -0.1 * high && high > -0.1 * low);
  const map = maps[isDiverging ? "diverging" : field.map || "sequential"];
  const range = legendRange(all, isDiverging);
  const place = value => clamp((value - range[0]) / (range[1] - range[0]), 0, 1);
  return { map, range, all, of: value => Number.isFinite(value) ? map[Math.round(place(value) * (kShades - 1))] : kNone };
}
