// Draws the picture of README.md: a valve open and closed, and closed with its chords, from the report of its solve.
//   coapt generate mitral --triangles 10000 -o valve && coapt solve valve/scene.json
//   NODE_PATH=tests/report/node_modules node docs/figures/closed_valve.mjs valve/result/report.html closed_valve.png
// Needs Chromium and playwright-core (npm ci in tests/report).
import { writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(import.meta.url)("playwright-core");
const [report, output] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]
});
const page = await browser.newPage({ viewport: { width: 1400, height: 1000 } });
await page.goto(pathToFileURL(resolve(report)).href);
await page.waitForSelector("#viewer[data-ready=yes]");
await page.locator("#field").selectOption({ label: "Displacement" });

// A view of a state, turned by keys: the middle of the picture without its frame, with a caption.
async function shot(state, view, keys, caption, lines) {
  const states = await page.locator("#state").getAttribute("max");
  await page.locator("#state").fill(state === "open" ? "0" : states);
  await page.locator(`[data-view=${view}]`).click();
  for (const line of ["#show-orifice", "#show-coaptation"])  // a valve that is tight has no orifice to show
    if (await page.locator(line).isVisible()) await page.locator(line).setChecked(lines);
  await page.locator("#canvas").focus();
  for (const key of keys) await page.keyboard.press(key);
  await page.evaluate(() => document.activeElement.blur());
  await page.waitForTimeout(500);
  const { x, y, width, height } = await page.locator("#canvas").boundingBox();
  const wide = 1.2 * height, frame = 3;
  const clip = { x: x + (width - wide) / 2, y: y + frame, width: wide, height: height - 2 * frame };
  const png = await page.screenshot({ clip });
  return `<figure><img src="data:image/png;base64,${png.toString("base64")}"><figcaption>${caption}</figcaption></figure>`;
}

const figures = [
  await shot("open", "above", [], "open, from the atrium", false),
  await shot("closed", "above", [], "closed under 120 mmHg", true),
  await shot("closed", "side", ["ArrowUp", "ArrowUp", "ArrowUp"], "closed, from the side", false)
];
const sheet = await browser.newPage({ viewport: { width: 990, height: 306 } });
await sheet.setContent(`<style>
  body { margin: 0; background: #f5f7f9; font: 15px "DejaVu Sans", sans-serif; color: #1b2733; display: flex; }
  figure { margin: 0; width: 330px; text-align: center } img { width: 330px; display: block; padding-bottom: 4px }
</style>${figures.join("")}`);
await sheet.waitForTimeout(300);
writeFileSync(output, await sheet.screenshot());
await browser.close();
