// What tests of pages in a headless Chromium have in common: pages made by the command, opened as a user does, and what
// must hold on every screen. Arguments of the program: COAPT_BINARY SAMPLE_PAGE_BINARY SCRATCH_FOLDER. Without a browser it
// ends with exit code 77: skipped, with the reason.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

export const [coapt, samplePage, scratch] = process.argv.slice(2);

function skip(reason) {
  console.log("skipped: " + reason);
  process.exit(77);
}

const browsers = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
const executablePath = browsers.find(path => existsSync(path));
if (!executablePath) skip("no Chromium; install the package chromium");
const { chromium } = await import("playwright-core").catch(() => skip("no playwright-core; run npm ci in tests/report"));

export function finished(...words) {
  try {
    execFileSync(coapt, words, { stdio: "pipe" });
  } catch (error) {
    if (error.status !== 1) throw error;  // 1: not converged, the result is there
  }
}

export function solved(name, shape, ...options) {
  const folder = join(scratch, name);
  mkdirSync(folder, { recursive: true });
  execFileSync(coapt, ["generate", ...shape, "-o", folder]);
  finished("solve", join(folder, "scene.json"), ...options);
  return join(folder, "result");
}

export const browser = await chromium.launch(
    { executablePath, args: ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"] });

const kPatience = 120000;  // ms: pictures are drawn by the processor, which other tests may keep busy

// The page of another command on a scene.
export function written(file, scene, command, ...options) {
  const folder = join(scratch, command);
  finished(command, scene, "-o", folder, ...options);
  return join(folder, file);
}

// A page, named by its file or the folder of its report.html, where `atFirst` is run before its scripts and whose errors and requests are counted; closed() asserts
// that there were none.
export async function opened(place, options = {}, atFirst = () => {}) {
  const page = await browser.newPage({ viewport: { width: 900, height: 760 }, ...options });
  await page.addInitScript(atFirst);
  const file = place.endsWith(".html") ? place : join(place, "report.html");
  const errors = [], requests = [], url = pathToFileURL(file).href;
  page.on("console", message => message.type() === "error" && errors.push(message.text()));
  page.on("pageerror", error => errors.push(error.message));
  page.on("request", request => request.url() !== url && !request.url().startsWith("data:") && requests.push(request.url()));
  page.setDefaultTimeout(kPatience);
  await page.goto(url);
  if (await page.locator("#viewer").count() > 0)
    await page.waitForSelector("#viewer[data-ready=yes]");
  const closed = async () => {
    await page.close();
    assert.deepEqual(errors, [], "errors on the console");
    assert.deepEqual(requests, [], "requests");
  };
  return { page, closed };
}

export const picture = page => page.locator("#canvas").screenshot();
export const shownValue = async (page, title) => {
  const row = page.locator("#values tr", { has: page.locator("th", { hasText: title }) }).first();
  return (await row.locator("td").textContent()).trim();
};
export const near = (text, value, digits) =>
    assert.ok(Math.abs(parseFloat(text) - value) <= 0.51 * 10 ** (Math.floor(Math.log10(Math.abs(value) || 1)) + 1 - digits),
              `${text} against ${value}`);

export async function pick(page, node) {
  await page.getByLabel("Node", { exact: true }).fill(String(node));
  assert.match(await page.locator("#picked").textContent(), new RegExp(`^Node ${node}\\.`));
}

// Nothing stands at the edge of a canvas: a text would be cut off there. And something stands inside of it, in the
// colours of the page.
export async function assertChartsAreDrawn(page, least) {
  const charts = page.locator("figure.plot .chart");
  assert.ok(await charts.count() >= least, "charts: " + await charts.count());
  for (const chart of await charts.all()) {
    const name = await chart.getAttribute("aria-label");
    const { edge, colours } = await chart.evaluate(chart => {
      const canvas = chart.querySelector("canvas"), { width, height } = canvas;
      const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
      const inks = new Map();
      let edge = 0;
      for (let y = 0; y < height; ++y)
        for (let x = 0; x < width; ++x) {
          const at = 4 * (y * width + x);
          if (data[at + 3] === 0) continue;
          if (x === 0 || y === 0 || x === width - 1 || y === height - 1) ++edge;
          if (data[at + 3] === 255) {
            const ink = data.slice(at, at + 3).join();
            inks.set(ink, (inks.get(ink) ?? 0) + 1);
          }
        }
      const style = getComputedStyle(document.documentElement), pen = new OffscreenCanvas(1, 1).getContext("2d");
      const series = JSON.parse(chart.querySelector("script").textContent).series;
      const colours = series.filter(each => each.x.length > 0).map(each => {
        pen.fillStyle = style.getPropertyValue("--s" + each.colour);
        pen.fillRect(0, 0, 1, 1);
        return inks.get([...pen.getImageData(0, 0, 1, 1).data.slice(0, 3)].join()) ?? 0;
      });
      return { edge, colours };
    });
    assert.equal(edge, 0, name + ": something is cut off");
    assert.ok(colours.every(pixels => pixels > 8), `${name}: pixels of each series: ${colours}`);
  }
}

// WCAG 2.2, relative luminance.
async function assertContrast(page, foreground, least) {
  const ratio = await page.evaluate(name => {
    const pen = new OffscreenCanvas(1, 1).getContext("2d"), style = getComputedStyle(document.documentElement);
    const luminance = name => {
      pen.fillStyle = style.getPropertyValue(name);
      pen.fillRect(0, 0, 1, 1);
      const [r, g, b] = [...pen.getImageData(0, 0, 1, 1).data].map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const [a, b] = [luminance(name), luminance("--ground")].sort((a, b) => b - a);
    return (a + 0.05) / (b + 0.05);
  }, foreground);
  assert.ok(ratio >= least, `${foreground}: contrast ${ratio.toFixed(2)}`);
}

// In both colour schemes and on a telephone: every chart is drawn, no text is too pale, nothing needs scrolling sideways.
export async function assertFitsEveryScreen(page, title, least) {
  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    for (const width of [390, 1280]) {
      await page.setViewportSize({ width, height: 760 });
      await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(wide <= 0, `${title} is ${wide} px wider than ${width}`);
      if (least > 0) await assertChartsAreDrawn(page, least);
    }
    for (const name of ["--ink", "--quiet", "--good", "--caution", "--bad", "--accent"]) await assertContrast(page, name, 4.5);
    for (let k = 0; k < 8; ++k) await assertContrast(page, "--s" + k, 3);
  }
}

let failures = 0;
// Runs a test and says how it went.
export async function run(name, body) {
  try {
    await body();
    console.log("ok      " + name);
  } catch (error) {
    ++failures;
    console.log("FAILED  " + name + "\n" + error.stack);
  }
}

// Ends the program.
export async function finish() {
  await browser.close();
  process.exit(failures === 0 ? 0 : 1);
}
