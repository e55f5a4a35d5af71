// Drives pages of several shapes, and the sliders of parameters, in a headless Chromium as a user does.
//   node shapes_test.mjs COAPT_BINARY SAMPLE_PAGE_BINARY SCRATCH_FOLDER
// Exit code 77: skipped, with the reason.
import assert from "node:assert/strict";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { assertFitsEveryScreen, browser, finish, finished, near, opened, pick, picture, run, scratch, shownValue, solved } from "./browser.mjs";
import { difference } from "./pictures.mjs";
import { readVtp } from "./vtp.mjs";

const folder = solved("mitral", ["mitral", "--triangles", "400"]), scene = join(scratch, "mitral", "scene.json");
const text = locator => locator.evaluate(element => element.textContent);
const chosen = page => page.getByLabel("Colour by").evaluate(select => select.selectedOptions[0].textContent);
const settled = page => page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));

// A scene file's comments go to the end of their line, and no text of it has two slashes.
const sceneOf = content => JSON.parse(content.replace(/\/\/.*$/gm, ""));

// Two parts of the picture as PNG files: left and right, or upper and lower.
async function halves(page, isBeside) {
  const box = await page.locator("#canvas").boundingBox();
  const part = k => ({ x: box.x + (isBeside ? k * box.width / 2 : 0), y: box.y + (isBeside ? 0 : k * box.height / 2),
                       width: isBeside ? box.width / 2 : box.width, height: isBeside ? box.height : box.height / 2 });
  return Promise.all([0, 1].map(k => page.screenshot({ clip: part(k), fullPage: true })));
}

await run("what leads through the shapes is seen without scrolling, and stands above the picture", async () => {
  for (const viewport of [{ width: 1280, height: 720 }, { width: 390, height: 844 }]) {
    const { page, closed } = await opened(folder, { viewport });
    const slider = await page.locator("#state").boundingBox(), canvas = await page.locator("#canvas").boundingBox();
    assert.ok(slider.y + slider.height < viewport.height, `at ${viewport.width}: ${slider.y}`);
    assert.ok(slider.y < canvas.y);
    await closed();
  }
});

await run("figures of a valve have their healthy ranges beside them", async () => {
  const { page, closed } = await opened(folder), result = JSON.parse(readFileSync(join(folder, "result.json")));
  assert.ok(result.healthy_closure.length >= 3);
  for (const criterion of result.healthy_closure) {
    const words = criterion.name.replace(/_(mm|ml)$/, "").replaceAll("_", " ");
    const tile = page.locator(`.tiles [data-figure="${words}"]`), range = tile.locator(".range");
    near(await text(tile.locator("[data-value]")), criterion.value, 3);
    for (const end of [criterion.lowest, criterion.highest])
      if (typeof end === "number") assert.match(await text(range), new RegExp(`\\b${Number(end.toPrecision(2))}\\b`));
    assert.equal(await range.evaluate(element => element.classList.contains("good")), criterion.met);
    assert.match(await text(range), criterion.met ? /^healthy: / : /^not in the healthy range: /);
  }
  await closed();
});

await run("before and after stand beside each other in the colours of what changes", async () => {
  const place = join(scratch, "intervene");
  finished("intervene", scene, "--edit", '{"type": "chord_length", "tips": [0, 1], "factor": 0.9}', "-o", place);
  const { page, closed } = await opened(join(place, "intervene.html"), { viewport: { width: 1280, height: 900 } });
  assert.equal(await chosen(page), "Change of greater principal Cauchy stress");
  assert.match(await text(page.locator("#legends")), /Change of greater principal Cauchy stress \[kPa\]/);
  assert.deepEqual(await page.locator("#pane-names span").allTextContents(), ["before", "after"]);
  const before = readVtp(join(place, "before", "closed.vtp")), after = readVtp(join(place, "after", "closed.vtp"));
  const way = node => Math.hypot(...[0, 1, 2].map(c => after.Points[3 * node + c] - before.Points[3 * node + c]));
  const node = before.triangles.reduce((best, corner) => way(corner) > way(best) ? corner : best), around = before.triangles.flatMap((corner, k) => corner === node ? [Math.floor(k / 3)] : []);
  const mean = vtp => around.reduce((sum, t) => sum + vtp.cells.cauchy_stress_1_kpa[vtp.lineCount + t], 0) / around.length;
  await pick(page, node);
  near(await shownValue(page, "Change of greater principal Cauchy stress"), mean(after) - mean(before), 3);
  near(await shownValue(page, "Distance between both shapes"), way(node), 3);
  const both = /^before: (\S+) mm; after: (\S+) mm$/.exec(await shownValue(page, "Displacement"));
  near(both[1], Math.hypot(...before.points.displacement.slice(3 * node, 3 * node + 3)), 4);
  near(both[2], Math.hypot(...after.points.displacement.slice(3 * node, 3 * node + 3)), 4);
  await page.getByLabel("Node", { exact: true }).fill("");

  // Each half is a picture of one shape; in one colour a half is the picture of that shape alone.
  await page.getByLabel("Colour by").selectOption({ label: "no colours" });
  for (const [width, isBeside] of [[1280, true], [390, false]]) {
    await page.setViewportSize({ width, height: 900 });
    await settled(page);
    assert.ok(await page.locator("#slider").isHidden());
    const [one, two] = await halves(page, isBeside);
    const apart = await difference(browser, one, two);
    assert.ok(apart.mean > 0.5, `at ${width}: two shapes, ${apart.mean} apart`);
    const names = await Promise.all((await page.locator("#pane-names span").all()).map(name => name.boundingBox()));
    const box = await page.locator("#canvas").boundingBox();
    const share = isBeside ? (names[1].x - box.x) / box.width : (names[1].y - box.y) / box.height;
    assert.ok(Math.abs(share - 0.5) < 0.02, "the second name stands at the second picture: " + share);
  }
  await page.setViewportSize({ width: 1280, height: 900 });

  // A click in the second picture picks in the second shape.
  await page.getByRole("button", { name: "From the atrium" }).click();
  const canvas = await page.locator("#canvas").boundingBox();
  await page.mouse.click(canvas.x + 0.75 * canvas.width, canvas.y + 0.35 * canvas.height);
  assert.match(await page.locator("#picked").textContent(), /^Node \d+, triangle \d+\./);

  await page.getByLabel("side by side").uncheck();
  const slider = page.getByRole("slider", { name: "Before ↔ after" });
  const alone = await picture(page);
  await slider.fill("0");
  assert.ok((await difference(browser, await picture(page), alone)).mean > 0.05);
  assert.equal(await page.locator("#state-label").textContent(), "before");
  await page.getByLabel("side by side").check();
  await assertFitsEveryScreen(page, "before and after", 0);
  await closed();
});

await run("a study shows the shapes of its points", async () => {
  const place = join(scratch, "study_shapes");
  finished("study", scene, "--sweep", "load_pressure.value=60,90,120 mmHg", "-o", place, "-j", "1");
  const { page, closed } = await opened(join(place, "study.html"));
  assert.equal(await chosen(page), "Greater principal Cauchy stress");
  const slider = page.getByRole("slider", { name: "load_pressure.value" });
  for (const [k, value] of [60, 90, 120].entries()) {
    await slider.fill(String(k));
    assert.equal(await page.locator("#state-label").textContent(), `load_pressure.value = ${value} mmHg`);
    const vtp = readVtp(join(place, "point_000" + k, "closed.vtp")), node = vtp.triangles[10];
    const { metrics } = JSON.parse(readFileSync(join(place, "point_000" + k, "result.json")));
    await pick(page, node);
    near(await shownValue(page, "Displacement"), Math.hypot(...vtp.points.displacement.slice(3 * node, 3 * node + 3)), 5);
    near((await text(page.locator("#orifice-text"))).match(/[0-9.e-]+ mm²$/)[0], metrics.orifice_area_mm2, 4);
    const around = vtp.triangles.flatMap((corner, t) => corner === node ? [Math.floor(t / 3)] : []);
    near(await shownValue(page, "Greater principal Cauchy stress"),
         around.reduce((sum, t) => sum + vtp.cells.cauchy_stress_1_kpa[vtp.lineCount + t], 0) / around.length, 4);
  }
  await closed();
});

await run("sliders move shape and figures to what a solve of the other scene finds", async () => {
  const place = folder, without = join(scratch, "no_sliders");
  finished("solve", scene, "--no-sliders", "-o", without);
  const more = statSync(join(place, "report.html")).size - statSync(join(without, "report.html")).size;
  assert.ok(more > 10000 && more <= 200000, more + " bytes more");
  const { page, closed } = await opened(place, { viewport: { width: 1280, height: 900 } });
  const group = page.getByRole("group", { name: "What if · first order" }), sliders = group.getByRole("slider");
  assert.equal(await sliders.count(), 8);
  const names = await group.locator("label").allTextContents(), k = names.indexOf("primary chords: rest length");
  assert.ok(k >= 0, names.join("; "));
  const before = await picture(page), vtp = readVtp(join(place, "closed.vtp"));
  const tile = name => page.locator(`.tiles [data-figure="${name}"] [data-value]`);
  const force = await text(tile("max chord force"));
  await sliders.nth(k).press("Home");
  const range = Number(await sliders.nth(k).getAttribute("min"));
  assert.ok(range < 0 && range >= -10);
  assert.ok((await difference(browser, await picture(page), before)).mean > 0.05, "the picture moves");
  assert.match(await text(group.locator("#what-if-note")), /^First order: within about [0-9.e-]+ mm of a solve/);

  // The same by a solve.
  const content = sceneOf(readFileSync(scene, "utf8"));
  content.interventions = [{ type: "chord_length", materials: "primary", factor: 1 + range / 100 }];
  writeFileSync(join(scratch, "mitral", "shorter.json"), JSON.stringify(content));
  finished("solve", join(scratch, "mitral", "shorter.json"), "-o", join(scratch, "shorter"), "--no-report");
  const other = readVtp(join(scratch, "shorter", "closed.vtp"));
  const { metrics } = JSON.parse(readFileSync(join(scratch, "shorter", "result.json")));
  near((await text(tile("max chord force"))).replace("≈ ", ""), metrics.max_chord_force_n, 3);
  near((await text(tile("max principal strain"))).replace("≈ ", ""), metrics.max_principal_strain, 3);
  for (const node of new Set(vtp.triangles.filter((_, c) => c % 97 === 0))) {
    await pick(page, node);
    const at = (await shownValue(page, "Position")).replace(" mm", "").split(", ").map(Number);
    const apart = Math.hypot(...at.map((value, c) => value - other.Points[3 * node + c]));
    assert.ok(apart <= 0.1, `node ${node} is ${apart} mm from the solve`);
  }

  await page.getByRole("button", { name: "Back to the result" }).click();
  await page.getByLabel("Node", { exact: true }).fill("");
  assert.equal(await text(tile("max chord force")), force);
  const left = (await difference(browser, await picture(page), before)).mean;
  assert.ok(left < 0.01, "as it was: " + left);
  await sliders.nth(0).press("End");
  await sliders.nth(1).press("End");
  assert.match(await text(group.locator("#what-if-note")), /^First order of several at once, which nobody has checked/);
  await assertFitsEveryScreen(page, "sliders", 2);
  await closed();
});

await run("a page without sliders shows none, and one that has none says why", async () => {
  const { page, closed } = await opened(join(scratch, "no_sliders"));
  assert.ok(await page.locator("#what-if").isHidden());
  await closed();
  const place = join(scratch, "cut_short");
  finished("solve", scene, "--max-seconds", "0.001", "-o", place);
  const cut = await opened(place);
  assert.equal(await text(cut.page.locator("#what-if-note")), "No sliders of parameters: the solve did not converge.");
  assert.equal(await cut.page.locator("#what-if").getByRole("slider").count(), 0);
  assert.ok(await cut.page.locator("#what-if-reset").isHidden());
  await cut.closed();
});

await finish();
