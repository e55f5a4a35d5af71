// Reference pictures of the page: small ones in pictures/, compared by what they show and not by their bytes.
// COAPT_UPDATE_GENERATED=1 in the environment writes them anew; look at them before they are committed.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const references = join(dirname(fileURLToPath(import.meta.url)), "pictures");
const renews = Boolean(process.env.COAPT_UPDATE_GENERATED);

// Pixels of a reference: so few that smoothing of edges by another renderer leaves little trace in them.
export const size = { width: 160, height: 120 };
const allowed = 0.12;  // of the ink, see difference()

// A screenshot of an element at whole pixels, in this size and before the page's background, wherever texts and their
// fonts have put it.
export async function framed(page, element, width, height) {
  const before = await element.evaluate((node, [width, height]) => {
    const style = node.getAttribute("style");
    const { backgroundColor } = getComputedStyle(document.body);
    Object.assign(node.style, { position: "fixed", left: 0, top: 0, zIndex: 9, maxWidth: "none", backgroundColor,
                                width: width + "px", height: height + "px" });
    return style;
  }, [width, height]);
  await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
  const png = await page.screenshot({ clip: { x: 0, y: 0, width, height } });
  await element.evaluate((node, style) => style === null ? node.removeAttribute("style") : node.setAttribute("style", style),
                         before);
  return png;
}

// A PNG of that size.
export async function reduced(browser, png) {
  const page = await browser.newPage();
  const text = await page.evaluate(async ([text, { width, height }]) => {
    const image = new Image();
    image.src = "data:image/png;base64," + text;
    await image.decode();
    const canvas = new OffscreenCanvas(width, height), pen = canvas.getContext("2d");
    pen.imageSmoothingQuality = "high";
    pen.drawImage(image, 0, 0, width, height);
    const bytes = new Uint8Array(await (await canvas.convertToBlob({ type: "image/png" })).arrayBuffer());
    return btoa(Array.from(bytes, byte => String.fromCharCode(byte)).join(""));
  }, [png.toString("base64"), size]);
  await page.close();
  return Buffer.from(text, "base64");
}

// How far a picture is from another one on a grid of that width. mean: over pixels and colours, 0 to 255. ink: the
// same relative to what there is to see, the mean distance of the first picture from the colour of its corner; so a
// thin curve counts as much as a sheet that fills the picture. isBlank: the first picture has one colour.
export async function difference(browser, one, other, { width, height } = size) {
  const page = await browser.newPage();
  const result = await page.evaluate(async ([texts, width, height]) => {
    const [a, b] = await Promise.all(texts.map(async text => {
      const image = new Image();
      image.src = "data:image/png;base64," + text;
      await image.decode();
      const canvas = new OffscreenCanvas(width, height), pen = canvas.getContext("2d");
      pen.imageSmoothingQuality = "high";
      pen.drawImage(image, 0, 0, width, height);
      return pen.getImageData(0, 0, width, height).data;
    }));
    const corner = 4 * (3 * width + 3);  // inside a frame
    let apart = 0, drawn = 0;
    for (let k = 0; k < a.length; ++k) {
      if (k % 4 === 3) continue;  // opaque
      apart += Math.abs(a[k] - b[k]);
      drawn += Math.abs(a[k] - a[corner + k % 4]);
    }
    return { mean: apart / (0.75 * a.length), ink: apart / drawn, isBlank: drawn === 0 };
  }, [[one.toString("base64"), other.toString("base64")], width, height]);
  await page.close();
  return result;
}

// The picture of `shot`, taken anew until `isRight` says so of how it differs from the reference or a minute is over: on a
// busy machine a screenshot may show what a canvas held before its last change.
async function awaited(browser, name, shot, isRight) {
  const file = join(references, name + ".png"), end = Date.now() + 60000;
  assert.ok(existsSync(file), "no reference " + file + "; COAPT_UPDATE_GENERATED=1 writes it");
  for (;;) {
    const small = await reduced(browser, await shot());
    const { ink } = await difference(browser, readFileSync(file), small);
    const { isBlank } = await difference(browser, small, small);
    if (isRight({ ink, isBlank }) || Date.now() > end) return { ink, isBlank, small, told: (100 * ink).toFixed(1) + " %" };
    await new Promise(done => setTimeout(done, 200));
  }
}

// Asserts that what `shot` takes comes to look like the reference of this name. Where it does not, the picture is left in
// `scratch`.
export async function looksLike(browser, name, shot, scratch) {
  if (renews) {
    mkdirSync(references, { recursive: true });
    await shot();  // the frame before may still be there
    writeFileSync(join(references, name + ".png"), await reduced(browser, await shot()));
  }
  const { ink, small, told } = await awaited(browser, name, shot, ({ ink }) => ink <= allowed);
  console.log(`        ${name}: ${told} of the ink elsewhere`);
  if (ink <= allowed) return;
  const kept = join(scratch, name + ".png");
  writeFileSync(kept, small);
  assert.fail(`${name} differs from its reference: ${told}; see ${kept}`);
}

// Asserts that what `shot` takes of a page with one fault does not look like that reference: a comparison that passes
// everything would be no test. Nor may it be blank, as what is not drawn yet is.
export async function looksUnlike(browser, name, shot) {
  const isFaulty = ({ ink, isBlank }) => ink > allowed && !isBlank;
  const found = await awaited(browser, name, shot, isFaulty);
  console.log(`        ${name}: ${found.told} with a fault`);
  assert.ok(isFaulty(found), `${name}: a picture with a fault passes too: ${found.told}`);
}
