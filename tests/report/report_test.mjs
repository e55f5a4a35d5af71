// Drives report.html in a headless Chromium as a user does: mouse, keyboard, screen reader names, printing.
//   node report_test.mjs COAPT_BINARY SAMPLE_PAGE_BINARY SCRATCH_FOLDER
// Pictures are compared with those in pictures/; COAPT_UPDATE_GENERATED=1 in the environment renews them (pictures.mjs).
// Exit code 77: skipped, with the reason.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { assertChartsAreDrawn, assertFitsEveryScreen, browser, finish, finished, near, opened, pick, picture, run, samplePage, scratch, shownValue,
         solved, written } from "./browser.mjs";
import { difference, framed, looksLike, looksUnlike } from "./pictures.mjs";
import { readVtp } from "./vtp.mjs";

// Each way leads from the start through iterates, each another shape, to a result.
async function assertWays(page, title) {
  const choice = page.getByLabel("Path of"), label = page.locator("#state-label");
  const ways = await choice.locator("option").allTextContents();
  assert.equal(await page.locator("#ways").isVisible(), ways.length > 1);
  assert.equal(ways.length, title.startsWith("Comparison") ? 2 : 1);
  await pick(page, await farthest(page));
  for (let k = 0; k < ways.length; ++k) {
    if (ways.length > 1) await choice.selectOption(String(k));
    const last = Number(await page.locator("#state").getAttribute("max")), seen = new Set();
    assert.ok(last >= 3, title + ", states: " + last);
    for (let state = 0; state <= last; ++state) {
      await page.locator("#state").fill(String(state));
      assert.match(await label.textContent(), state === 0 ? /^start, as given/ : state < last ? /^iterate \d+, residual/ : ways[k] ? /residual/ : /^result: converged/);
      seen.add(await shownValue(page, "Position"));
    }
    assert.equal(seen.size, last + 1, title + ": every stop is another shape");
    if (ways[k]) assert.ok((await label.textContent()).startsWith(ways[k]));
  }
}

// The node that moves farthest.
const farthest = page => page.evaluate(() => {
  const data = JSON.parse(document.getElementById("shape-data").textContent);
  const read = text => new Float32Array(Uint8Array.from(atob(text), letter => letter.charCodeAt(0)).buffer);
  const from = read(data.states[0].nodes), to = read(data.states.at(-1).nodes);
  const way = Array.from({ length: from.length / 3 }, (_, n) => Math.hypot(...[0, 1, 2].map(c => to[3 * n + c] - from[3 * n + c])));
  return way.indexOf(Math.max(...way));
});

const tests = {
  async "the slider leads through real iterates to the shape of closed.vtp"({ page, vtp }) {
    const slider = page.getByRole("slider", { name: "Open ↔ closed" });
    const last = Number(await slider.getAttribute("max"));
    assert.ok(last >= 4, "iterates: " + last);
    const node = vtp.points.displacement.reduce((best, _, k, all) =>
        k % 3 === 0 && Math.hypot(...all.slice(k, k + 3)) > best.size ? { size: Math.hypot(...all.slice(k, k + 3)), at: k / 3 } : best,
        { size: 0, at: -1 });
    await pick(page, node.at);
    const place = async () => (await shownValue(page, "Position")).replace(" mm", "").split(", ").map(Number);
    const closed = await place(), closedPicture = await picture(page);
    closed.forEach((value, c) => assert.ok(Math.abs(value - vtp.Points[3 * node.at + c]) < 1e-3));
    const seen = new Set();
    for (let state = last; state >= 0; --state) {
      await slider.fill(String(state));
      seen.add((await place()).join());
    }
    assert.equal(seen.size, last + 1, "every stop of the slider is another shape");
    const open = await place();
    closed.forEach((value, c) => assert.ok(
        Math.abs(value - open[c] - vtp.points.displacement[3 * node.at + c]) < 1e-3, "the first is the start"));
    assert.equal(await page.locator("#state-label").textContent(), "start, as given");
    assert.ok((await difference(browser, await picture(page), closedPicture)).mean > 2, "the picture moves with the slider");
    await slider.press("End");
    assert.match(await slider.getAttribute("aria-valuetext"), /^result: converged/);
  },

  async "opens on the Cauchy stress of closed.vtp, not on the gap"({ page, vtp }) {
    assert.equal(await page.getByLabel("Colour by").evaluate(select => select.selectedOptions[0].textContent), "Greater principal Cauchy stress");
    assert.equal(await page.locator("#legends .title").first().textContent(), "Greater principal Cauchy stress [kPa]");
    const node = vtp.triangles[0], around = vtp.triangles.flatMap((corner, k) => corner === node ? [Math.floor(k / 3)] : []);
    const mean = name => around.reduce((sum, t) => sum + vtp.cells[name][vtp.lineCount + t], 0) / around.length;
    await pick(page, node);
    near(await shownValue(page, "Greater principal Cauchy stress"), mean("cauchy_stress_1_kpa"), 4);
    near(await shownValue(page, "Von Mises stress"), mean("von_mises_stress_kpa"), 4);
  },

  async "picking a node shows its values in closed.vtp"({ page, vtp }) {
    const vertices = Math.max(...vtp.triangles) + 1;
    const touching = vtp.points.gap.findIndex((gap, k) => k < vertices && gap > 0 && gap < 1);
    assert.ok(touching >= 0);
    await pick(page, touching);
    near(await shownValue(page, "Gap"), vtp.points.gap[touching], 5);
    near(await shownValue(page, "Displacement"), Math.hypot(...vtp.points.displacement.slice(3 * touching, 3 * touching + 3)), 5);
    const around = vtp.triangles.flatMap((corner, k) => corner === touching ? [Math.floor(k / 3)] : []);
    const strain = around.reduce((sum, t) => sum + vtp.cells.principal_strain_1[vtp.lineCount + t], 0) / around.length;
    near(await shownValue(page, "Greater principal strain"), strain, 4);
  },

  async "picking shows the extremes of result.json"({ page, vtp, folder }) {
    const { metrics } = JSON.parse(readFileSync(join(folder, "result.json")));
    const vertices = Math.max(...vtp.triangles) + 1;
    const moved = Array.from({ length: vertices }, (_, n) => Math.hypot(...vtp.points.displacement.slice(3 * n, 3 * n + 3)));
    await pick(page, moved.indexOf(Math.max(...moved)));
    near(await shownValue(page, "Displacement"), metrics.max_displacement_mm, 5);
    const force = vtp.cells.line_force_n.slice(0, vtp.lineCount);
    await pick(page, vtp.lines[2 * force.indexOf(Math.max(...force))]);
    const forces = await page.locator("#values tr", { has: page.locator("th", { hasText: "Chord or cable" }) }).locator("td").allTextContents();
    near(String(Math.max(...forces.map(parseFloat))), metrics.max_chord_force_n, 5);
    const stress = vtp.cells.line_cauchy_stress_kpa.slice(0, vtp.lineCount), greatest = Math.max(...stress);
    near(String(greatest), metrics.max_chord_stress_kpa, 6);
    await pick(page, vtp.lines[2 * stress.indexOf(greatest)]);
    const told = await page.locator("#values tr", { has: page.locator("th", { hasText: "Chord or cable" }) }).locator("td").allTextContents();
    const stresses = told.map(text => parseFloat(/Cauchy stress ([-0-9.e+]+) kPa/.exec(text)[1]));
    near(String(Math.max(...stresses)), greatest, 4);
    assert.ok(told.every(text => /strain -?[0-9.e+-]+/.test(text)), told.join("; "));
  },

  async "a click picks what lies there, and nothing beside it"({ page, vtp }) {
    await page.getByRole("button", { name: "From the atrium" }).click();
    const box = await page.locator("#canvas").boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height * 0.4);
    const [, node, triangle] = /^Node (\d+), triangle (\d+)\./.exec(await page.locator("#picked").textContent());
    assert.ok(vtp.triangles.slice(3 * triangle, 3 * triangle + 3).includes(Number(node)));
    near(await shownValue(page, "Displacement"), Math.hypot(...vtp.points.displacement.slice(3 * node, 3 * node + 3)), 5);
    await page.mouse.click(box.x + 3, box.y + 3);
    assert.equal(await page.locator("#picked").textContent(), "Nothing picked.");
  },

  async "colours, cut and keys change the picture"({ page }) {
    let before = await picture(page);
    const changes = async what => {
      const now = await picture(page);
      assert.ok(!now.equals(before), what);
      before = now;
    };
    const field = page.getByLabel("Colour by");
    for (const title of (await field.locator("option").allTextContents()).slice(1)) {
      await field.selectOption({ label: title });
      await changes(title);
    }
    await page.getByLabel("Plane", { exact: true }).selectOption("right");
    await changes("cut");
    await page.getByLabel("Place of the cutting plane").fill("40");
    await changes("place of the cut");
    await page.getByLabel("chords and cables").uncheck();
    await changes("chords");
    await page.locator("#canvas").focus();
    await page.keyboard.press("ArrowLeft");
    await changes("arrow key");
    await page.keyboard.press("+");
    await changes("plus");
    await page.getByLabel("Plane", { exact: true }).selectOption("");
    await page.getByLabel("chords and cables").check();
    await page.getByRole("button", { name: "Oblique" }).click();
  },

  async "figures are those of result.json"({ page, folder }) {
    const result = JSON.parse(readFileSync(join(folder, "result.json")));
    const table = page.getByRole("table", { name: /^All figures/ });
    const text = title =>
      table.getByRole("row", { name: title, exact: false }).first().getByRole("cell").first().textContent();
    for (const [title, value] of [["orifice area", result.metrics.orifice_area_mm2],
                                  ["max principal strain", result.metrics.max_principal_strain],
                                  ["coaptation length", result.metrics.coaptation_length_mm]])
      near(await text(title), value, 5);
    assert.equal(result.metrics.coaptation_area_mm2, null, "so coarse a mesh resolves none");
    assert.match(await text("coaptation area"), /^-.*not resolved by this mesh/s);
    assert.equal(await page.locator("header .lead").textContent(), [result.message, ...result.doubts].join("; "));
    assert.ok(await page.getByText(result.certificate.summary).count() > 0);
    assert.equal(await page.locator("figure.plot [role=img]").count(), 2);
    await assertChartsAreDrawn(page, 2);
  },

  async "the orifice is drawn with its area, and every legend has its unit and its ends"({ page, vtp, folder }) {
    const result = JSON.parse(readFileSync(join(folder, "result.json")));
    const orifice = page.getByLabel(/orifice outline/);
    near((await page.locator("#orifice-text").textContent()).match(/[0-9.e-]+ mm²$/)[0], result.metrics.orifice_area_mm2, 4);
    await page.getByRole("button", { name: "From the atrium" }).click();
    const drawn = await picture(page);
    await orifice.uncheck();
    assert.ok(!(await picture(page)).equals(drawn), "the outline goes");
    await orifice.check();
    assert.ok((await picture(page)).equals(drawn), "and comes back");
    const legends = page.locator("#legends");
    await page.getByLabel("Colour by").selectOption({ label: "Displacement" });
    const sizes = vtp.points.displacement.flatMap((_, k, all) => k % 3 === 0 ? [Math.hypot(...all.slice(k, k + 3))] : []);
    assert.match(await legends.textContent(), /Displacement \[mm\]/);
    const ends = (await legends.textContent()).match(/values from ([0-9.e-]+) to ([0-9.e-]+) mm/);
    near(ends[2], Math.max(...sizes.slice(0, Math.max(...vtp.triangles) + 1)), 4);
    assert.match(await legends.textContent(), /Force in chords and cables \[N\]/);
    near((await legends.textContent()).match(/to ([0-9.e-]+) N/)[1], result.metrics.max_chord_force_n, 4);
    await page.getByLabel("Colour by").selectOption({ index: 0 });
  },

  async "Enter picks what lies in the middle, and Home looks as at first"({ page, vtp }) {
    await page.getByRole("button", { name: "Oblique" }).click();
    const first = await picture(page);
    await page.locator("#canvas").focus();
    await page.keyboard.press("ArrowLeft");
    assert.ok(!(await picture(page)).equals(first));
    await page.keyboard.press("Enter");
    const [, node, triangle] = /^Node (\d+), triangle (\d+)\./.exec(await page.locator("#picked").textContent());
    assert.ok(vtp.triangles.slice(3 * triangle, 3 * triangle + 3).includes(Number(node)));
    await page.getByLabel("Node", { exact: true }).fill("");
    await page.locator("#canvas").focus();
    await page.keyboard.press("Home");
    assert.ok((await difference(browser, await picture(page), first)).mean < 1, "as at first");
  },

  async "the valve looks as it did, closed and open"({ page }) {
    const view = name => page.getByRole("button", { name, exact: true }).click();
    const colour = label => page.getByLabel("Colour by").selectOption({ label });
    const shot = () => framed(page, page.locator("#canvas"), 640, 480);
    const slider = page.getByRole("slider", { name: "Open ↔ closed" });
    await view("From the atrium");
    await page.getByLabel("chords and cables").uncheck();  // slack ones lie anywhere
    await colour("Displacement");
    await looksLike(browser, "closed_displacement", shot, scratch);
    await colour("no colours");
    await looksUnlike(browser, "closed_displacement", shot);
    await colour("Greater principal strain");
    await view("Side");
    await looksLike(browser, "closed_strain", shot, scratch);
    await view("Oblique");
    await looksUnlike(browser, "closed_strain", shot);
    await page.getByLabel("chords and cables").check();
    await page.getByLabel("mesh", { exact: true }).check();
    await colour("Region");
    await slider.fill("0");
    await looksLike(browser, "open_regions", shot, scratch);
    await slider.press("End");
    await looksUnlike(browser, "open_regions", shot);
    await page.getByLabel("mesh", { exact: true }).uncheck();
    await page.getByLabel("Colour by").selectOption({ index: 0 });
  },

  async "a picture can be saved, and the page printed"({ page }) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save a picture" }).click()]);
    assert.equal(readFileSync(await download.path()).subarray(1, 4).toString(), "PNG");
    await page.emulateMedia({ media: "print" });
    assert.ok(await page.locator("#slider").isHidden());
    assert.ok(await page.locator("#canvas").isVisible());
    await page.emulateMedia({ media: "screen" });
  },
};

const folder = solved("mitral", ["mitral", "--preset", "benchmark", "--triangles", "400"]);
const vtp = readVtp(join(folder, "closed.vtp"));
const { page, closed } = await opened(folder);
for (const [name, test] of Object.entries(tests)) await run(name, () => test({ page, vtp, folder }));
await run("no errors and no requests on a valve", closed);
await run("a chain without a sheet is drawn too, in the dark", async () => {
  const chain = await opened(solved("chain", ["catenary"]), { colorScheme: "dark" });
  const shot = () => framed(chain.page, chain.page.locator("#canvas"), 640, 480);
  await looksLike(browser, "chain", shot, scratch);
  await chain.page.getByRole("slider", { name: "Start ↔ result" }).fill("0");
  await looksUnlike(browser, "chain", shot);
  await chain.closed();
});
// A shallow pyramid, pushed at its apex, which is also at rest turned inside out.
function pyramidResult() {
  const folder = join(scratch, "pyramid");
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, "pyramid.obj"), "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nv 0 0 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
  writeFileSync(join(folder, "scene.json"), JSON.stringify({
    mesh: { file: "pyramid.obj" }, boundary: [{ nodes: "boundary", fix: true }],
    terms: [{ type: "cst_stvk", young: "1 MPa", poisson: 0.3, thickness: "0.5 mm" },
            { type: "load_field", nodes: [4], force: "0.001 N", direction: [0, 0, -1] }] }));
  finished("solve", join(folder, "scene.json"), "--branches", "12", "--branch-kick", "0.5");
  return { solve: join(folder, "result"), compare: written("compare.html", join(folder, "scene.json"), "compare", "--methods", "newton,lbfgs", "--branches", "12", "--branch-kick", "0.5") };
}
await run("every warning stands above the figures, in sight", async () => {
  for (const place of Object.values(pyramidResult())) {
    const { page, closed } = await opened(place);
    const list = page.getByRole("region", { name: "Warnings" }).getByRole("listitem");
    const texts = (await list.allTextContents()).join("\n");
    assert.match(texts, /one of several equilibria: 1 other near by/);
    assert.match(texts, /not determined: 1 /);
    const figures = await page.locator("dl.tiles, table").first().boundingBox();
    for (const warning of await page.locator("p.caution, p.bad, li.caution, li.bad").all()) {
      const box = await warning.boundingBox();
      assert.ok(box && box.y + box.height <= figures.y, await warning.textContent());
    }
    for (const warning of await list.all()) assert.ok((await warning.boundingBox()).y < 760, "seen without scrolling");
    await closed();
  }
});
const sampleFolder = (name, text) => {
  const folder = join(scratch, name);
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, "report.html"), text);
  return folder;
};
const sample = execFileSync(samplePage, { encoding: "utf8" });
await run("plots look as they did, in light and dark", async () => {
  const right = sampleFolder("sample", sample), spoilt = sampleFolder("spoilt", sample.replace('"joined":true', '"joined":false'));
  for (const colorScheme of ["light", "dark"]) {
    for (const folder of [right, spoilt]) {
      const { page, closed } = await opened(folder, { colorScheme }, () => {  // without texts, whose fonts differ
        CanvasRenderingContext2D.prototype.fillText = () => {};
        CanvasRenderingContext2D.prototype.measureText = () => ({ width: 30 });
      });
      await page.addStyleTag({ content: "figure.plot .axis { visibility: hidden }" });
      const shot = () => framed(page, page.getByRole("img", { name: /^Error against time/ }), 720, 440);
      if (folder === right) await looksLike(browser, "plot_" + colorScheme, shot, scratch);
      else await looksUnlike(browser, "plot_" + colorScheme, shot);
      await closed();
    }
  }
});
await run("axes are logarithmic where values span decades, and no point is lost", async () => {
  const { page, closed } = await opened(join(scratch, "sample"));
  const isLogarithmic = name => page.locator("figure.plot", { hasText: new RegExp("^\\s*" + name) }).first()
      .evaluate(figure => JSON.parse(figure.querySelector(".chart script").textContent).y.logarithmic);
  for (const [name, expected] of [["Error against time", true], ["Narrow", false], ["Zeros", true], ["Below zero", false], ["Named", true]])
    assert.equal(await isLogarithmic(name), expected, name);
  await assertChartsAreDrawn(page, 7);
  assert.ok(await page.getByText("1 point is zero: it stands as an open triangle").isVisible());
  await closed();
});
await run("a decade far below the others has its number, not zero", async () => {
  const { page, closed } = await opened(join(scratch, "sample"), {}, () => {
    window.drawn = [];
    const fill = CanvasRenderingContext2D.prototype.fillText;
    CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
      window.drawn.push({ text, x, chart: this.canvas.closest?.(".chart")?.getAttribute("aria-label") ?? "" });
      fill.call(this, text, x, y);
    };
  });
  await assertChartsAreDrawn(page, 7);
  const drawn = (await page.evaluate(() => window.drawn)).filter(({ chart }) => chart.startsWith("Zeros"));
  const upright = drawn.find(({ text }) => /^10⁻/.test(text))?.x, texts = drawn.filter(({ x }) => x === upright).map(({ text }) => text);
  assert.ok(texts.some(text => /^10⁻[⁶⁷⁸⁹]$/.test(text)) && !texts.includes("0"), texts.join(", "));
  await closed();
});
await run("the pointer shows the values of a point, and the key what its marks mean", async () => {
  const { page, closed } = await opened(join(scratch, "sample"));
  const figure = page.locator("figure.plot").first(), tip = figure.locator(".tip");
  assert.ok(await tip.isHidden());
  const box = await figure.locator(".u-over").boundingBox();
  const last = { x: Math.log10(30 / 0.1) / Math.log10(50 / 0.1), y: Math.log10(10 / 1e-2) / Math.log10(10 / 1e-6) };
  await page.mouse.move(box.x + last.x * box.width, box.y + last.y * box.height);
  assert.equal(await tip.textContent(), "two, stopped at its time limit: time [s] 30, error [mm] 0.01 (stopped early)");
  await page.mouse.move(box.x + 3, box.y + box.height - 3);
  assert.ok(await tip.isHidden(), "nothing is near");
  assert.deepEqual(await figure.locator(".key li").allTextContents(), ["one", "two", "three", "stopped early"]);
  await closed();
});
await run("pages of compare, bench, study, tune and stress work as that of solve does, and fit on screens and paper", async () => {
  solved("disc", ["disc", "--triangles", "100"]);
  const disc = join(scratch, "disc", "scene.json"), valve = join(scratch, "mitral", "scene.json"), few = ["--methods", "newton,lbfgs"];
  for (const [title, place, charts] of [
         ["Result of parametric mitral valve (scene.json)", folder, 2],
         ["Comparison of methods on disc (scene.json)", written("compare.html", disc, "compare", ...few), 3],
         ["Benchmark of disc (scene.json)",
          written("bench.html", disc, "bench", ...few, "--tolerances", "1e-2,1e-6", "--repeats", "1"), 2],
         ["Stability matrix of disc (scene.json)", written("stress.html", disc, "stress", "--rows", "S1,S4,S8", "--quick"), 0],
         ["Study of parametric mitral valve (scene.json)", written("study.html", valve, "study", "--sweep", "load_pressure.value=60,120 mmHg"), 4],
         ["Chord lengths of parametric mitral valve (scene.json)",
          written("tuning.html", valve, "tune", "--orifice-weight", "1", "--by", "tip", "--max-solves", "6"), 1]]) {
    const { page, closed } = await opened(place);
    assert.equal(await page.getByRole("heading", { level: 1 }).textContent(), title);
    assert.ok(await page.getByRole("table").count() > 0);
    assert.doesNotMatch(await page.locator("main").textContent(), /\b[a-z]+(_[a-z]+)*_(mm[23]?|kpa|n)\b/, "keys of files in a page");
    if (await page.locator("#viewer").count() > 0 && /^(Comp|Bench|Stab)/.test(title)) await assertWays(page, title);
    if (/^(Comp|Bench|Stab)/.test(title))
      for (const part of [/version of coapt/, /certificate/i, /^Residual against iterates/])
        assert.ok(await page.getByText(part).count() + await page.getByRole("img", { name: part }).count() > 0, title + ": " + part);
    await assertFitsEveryScreen(page, title, charts);
    await page.emulateMedia({ media: "print" });
    await page.setViewportSize({ width: 718, height: 1000 });  // A4 without its margins, 96 to an inch
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), title + " is wider than paper");
    if (charts > 0) await assertChartsAreDrawn(page, charts);
    await closed();
  }
});
await run("pages open on stress with the slider in sight, and a change shows where zero is", async () => {
  const edit = '{"type": "ring", "size": "28 mm", "stiffness": "flexible"}';
  const before = written("intervene.html", join(scratch, "mitral", "scene.json"), "intervene", "--edit", edit);
  for (const place of [folder, join(scratch, "compare", "compare.html"), join(scratch, "bench", "bench.html")])
    for (const [width, height] of [[1200, 800], [390, 844]]) {
      const { page, closed } = await opened(place, { viewport: { width, height } });
      const box = await page.locator("#slider").boundingBox();
      assert.ok(box.y + box.height <= height, `${place}, ${width} px: the slider ends at ${box.y + box.height}`);
      assert.equal(await page.locator("#legends .title").first().textContent(), "Greater principal Cauchy stress [kPa]");
      await closed();
    }
  const { page, closed } = await opened(before, { viewport: { width: 390, height: 844 } });
  assert.match(await page.locator("#legends .title").first().textContent(), /^Change of greater principal Cauchy stress/);
  const ends = (await page.locator("#legends .scale").first().locator("span").allTextContents()).map(Number);
  assert.ok(ends.at(-1) > 0 && ends[0] === -ends.at(-1), "ends: " + ends);
  const change = page.getByRole("table", { name: /^Every figure/ }).getByRole("columnheader").last(), { x, width } = await change.boundingBox();
  assert.ok(x + width <= 390, "the change ends at " + (x + width));
  await closed();
});
await run("what a telephone scrolls to makes no row high", async () => {
  const { page, closed } = await opened(folder, { viewport: { width: 390, height: 844 } });
  const heights = await page.getByRole("table", { name: /^A healthy closure/ }).getByRole("row").evaluateAll(rows => rows.map(row => row.offsetHeight));
  assert.ok(heights.length > 2 && Math.max(...heights) < 110, heights.join(", "));
  await closed();
});
await run("10,000 triangles take less than 5 MB", async () => {
  // The valve's with chords, contact and orifices, some iterates into its closure.
  for (const [shape, seconds] of [["disc", "0.5"], ["mitral", "4"]]) {
    const folder = solved("large_" + shape, [shape, "--triangles", "10000"], "--max-seconds", seconds);
    const size = statSync(join(folder, "report.html")).size;
    assert.ok(size > 1e6 && size < 5e6, shape + ": " + size + " bytes");
  }
  // Of every method there is.
  const page = written("compare.html", join(scratch, "large_mitral", "scene.json"), "compare", "--max-seconds", "1");
  const size = statSync(page).size;
  assert.ok(size > 2e6 && size < 5e6, "compare: " + size + " bytes");
});
await finish();
