// Put into a page by browser_test.cc: uses it as a person does, and leaves what it saw in the
// attribute `data-probe` of the body.
addEventListener("load", async () => {
  const faults = [];
  const expect = (holds, what) => { if (!holds) faults.push(what); };
  const seen = {};
  const press = (element, key) =>
    element.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
  const byId = (id) => document.getElementById(id);
  const luminance = ([r, g, b]) => {
    const part = (v) => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
    return 0.2126 * part(r) + 0.7152 * part(g) + 0.0722 * part(b);
  };
  const color = (text) => {
    const parts = text.match(/[\d.]+/g).map(Number);
    return text.startsWith("rgb") ? [...parts.slice(0, 3), parts[3] ?? 1] : [0, 0, 0, 0];
  };
  const background = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const found = color(getComputedStyle(at).backgroundColor);
      if (found[3] > 0.99) return found;
    }
    return [255, 255, 255, 1];
  };
  // WCAG 2.1, 1.4.3: 4.5 to 1; large text 3 to 1.
  let least = 99;
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  let looked = 0;
  for (let node; (node = walker.nextNode()) && looked < 6000;) {
    ++looked;
    const element = node.parentElement;
    if (!node.textContent.trim() || !element.checkVisibility() || element.closest(".skip")) continue;
    if (["SCRIPT", "STYLE", "OPTION", "title", "desc"].includes(element.tagName)) continue;
    const style = getComputedStyle(element);
    const ink = color(element.closest("svg") ? style.fill : style.color);
    const [a, b] = [luminance(ink), luminance(background(element))].sort((p, q) => q - p);
    const ratio = (a + 0.05) / (b + 0.05);
    const large = parseFloat(style.fontSize) >= 24;
    least = Math.min(least, ratio);
    if (ratio < (large ? 3 : 4.5)) faults.push(`contrast ${ratio.toFixed(2)}: ${node.textContent.slice(0, 40)}`);
  }
  seen.contrast = least;
  seen.hostile = window.hostile ?? 0;
  seen.images = document.images.length;
  seen.turned = (document.body.textContent.match(/[\u202a-\u202e\u2066-\u2069\u200e\u200f]/g) ?? []).length;
  for (const control of document.querySelectorAll("button, select, input")) {
    const name = control.getAttribute("aria-label") ??
      (control.labels?.length ? control.labels[0].textContent : control.textContent);
    expect(name.trim(), `a control without a name: ${control.outerHTML.slice(0, 80)}`);
  }
  for (const image of document.querySelectorAll("svg")) {
    expect(image.getAttribute("role") === "img" &&
      (image.getAttribute("aria-label") || image.querySelector("title")), "a picture without a name");
  }
  expect(document.documentElement.scrollWidth <= innerWidth, "the page is wider than the window");
  // Cells may be wider than the window where their table can be moved in it.
  for (const element of document.querySelectorAll("table, figure, svg, pre, dl, header, code.command")) {
    if (!element.checkVisibility() || element.closest(".scroll, .plot-box, pre, .command")) continue;
    expect(element.getBoundingClientRect().right <= innerWidth + 1,
      `cut at the side: ${element.outerHTML.slice(0, 60)}`);
  }
  for (const canvas of document.querySelectorAll("canvas.dots")) {
    if (!canvas.checkVisibility()) continue;
    canvas.scrollIntoView();
    await new Promise((done) => setTimeout(done, 200));
    const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    let painted = 0;
    for (let i = 3; i < pixels.length; i += 4) painted += pixels[i] > 0 ? 1 : 0;
    expect(painted > 100, "a canvas is blank");
    seen.canvases = (seen.canvases ?? 0) + 1;
  }

  const table = byId("samples-table");
  if (table) {
    const rows = () => [...table.tBodies[0].rows].filter((row) => !row.hidden);
    const first = () => rows()[0].cells[0].textContent;
    const heads = [...table.tHead.rows[0].cells];
    const all = rows().length, before = first();
    heads[0].querySelector("button").click();
    heads[0].querySelector("button").click();
    expect(heads[0].getAttribute("aria-sort") === "descending", "not sorted downwards");
    expect(all < 2 || first() !== before, "sorting changes nothing");
    heads[0].querySelector("button").click();
    expect(first() === before, "sorting back does not give the first order");
    byId("by-verdict").value = "discrepancy";
    byId("by-verdict").dispatchEvent(new Event("input"));
    expect(rows().every((row) => row.cells[1].textContent.startsWith("discrepancy")), "filter lets others by");
    seen.discrepancies = rows().length;
    byId("by-verdict").value = "";
    byId("by-verdict").dispatchEvent(new Event("input"));
    expect(rows().length === all, "the filter does not let go");
    seen.rows = all;
  }
  const map = byId("map-svg");
  if (map) {
    map.focus();
    expect(document.activeElement === map, "the map takes no focus");
    press(map, "ArrowRight");
    expect(byId("map-says").textContent.startsWith("Simulation "), "arrows choose no simulation");
    expect(byId("map-hover").childElementCount > 0, "no way is drawn");
    press(map, " ");
    seen.says = byId("map-says").textContent;
    const wide = map.viewBox.baseVal.width;
    press(map, "+");
    expect(map.viewBox.baseVal.width < wide, "no zoom");
    byId("map-all").click();
    expect(map.viewBox.baseVal.width === wide, "no way back from the zoom");
    press(map, "Escape");
    expect(byId("map-hover").childElementCount === 0, "Escape leaves the way");
    expect(map.getBoundingClientRect().height > 100, "the map has no height");
  }
  const steady = document.querySelector("input.all");
  if (steady) {
    const row = steady.closest("details").querySelector("tr.steady");
    expect(!row.checkVisibility(), "what does not change is shown");
    steady.click();
    expect(row.checkVisibility(), "what does not change cannot be shown");
    steady.click();
  }
  const link = document.querySelector('a[href^="#s0-"], a[href^="#s1-"]');
  if (link) {
    link.click();
    await new Promise((done) => setTimeout(done, 300));
    expect(document.querySelector(link.getAttribute("href")).checkVisibility(), "the source stays shut");
  }
  seen.focusable = [...document.querySelectorAll("a[href], button, select, input, summary, [tabindex='0']")]
    .filter((element) => element.checkVisibility()).length;
  for (let i = 0; i < 200 && byId("motion-data") && !byId("motion").dataset.state; ++i) {
    await new Promise((done) => setTimeout(done, 50));
  }
  const replay = byId("motion")?.replay;
  if (replay) {
    const stage = byId("motion-stage"), motion = { stats: [], poses: [] };
    // What is on the canvas, as numbers: the drawing is kept for as long as the task lasts.
    const look = () => {
      replay.draw();
      const copy = document.createElement("canvas");
      [copy.width, copy.height] = [replay.canvas.width, replay.canvas.height];
      const pen = copy.getContext("2d");
      pen.drawImage(replay.canvas, 0, 0);
      const pixels = pen.getImageData(0, 0, copy.width, copy.height).data;
      let sum = 0, squares = 0, mark = 0;
      for (let i = 0; i < pixels.length; i += 4) {
        const grey = pixels[i] + pixels[i + 1] + pixels[i + 2];
        sum += grey;
        squares += grey * grey;
        mark = (mark * 31 + grey) % 1000000007;
      }
      const count = pixels.length / 4;
      return { mean: sum / count, spread: Math.sqrt(squares / count - (sum / count) ** 2), mark };
    };
    const data = JSON.parse(byId("motion-data").textContent), run = data.runs[0];
    replay.choose(0, run.beside);
    motion.names = replay.names();
    const end = run.events[run.events.length - 1].end;
    for (const share of [0, 0.5, 1]) {
      replay.seek(share * end);
      motion.stats.push(look());
    }
    const moving = data.scenes[run.scene].bodies.filter((body) => body.moves).map((body) => body.name);
    const steps = [...byId("motion-events").children];
    expect(steps.length === run.events.length, "not a button for each event");
    for (const step of steps) {
      step.querySelector("button").click();
      const places = {};
      for (const name of moving) places[name] = replay.poseOf(name);
      motion.poses.push({ time: replay.time(), places, says: byId("motion-says").textContent });
    }
    stage.focus();
    expect(document.activeElement === stage, "the stage takes no focus");
    replay.seek(0);
    press(stage, "ArrowRight");
    const first = replay.time();
    press(stage, "ArrowRight");
    expect(first > 0 && replay.time() > first, "the arrow does not go from event to event");
    press(stage, "ArrowLeft");
    expect(Math.abs(replay.time() - first) < 1e-9, "the arrow does not go back");
    press(stage, " ");
    expect(replay.playing() && byId("motion-play").textContent === "Pause", "space does not play");
    press(stage, " ");
    expect(!replay.playing(), "space does not pause");
    const before = look().mark;
    press(stage, "ArrowUp");
    expect(look().mark !== before, "the view does not turn");
    for (const view of ["top", "front", "robot", "world"]) {
      document.querySelector(`[data-view=${view}]`).click();
      motion[view] = look();
      expect(motion[view].spread > 5, `nothing is seen from ${view}`);
    }
    const follow = byId("motion-follow");
    follow.value = follow.options[follow.options.length - 1].value;
    follow.dispatchEvent(new Event("input"));
    expect(look().mark !== motion.world.mark, "following a body changes nothing");
    const shows = document.querySelectorAll("#samples-table button.show");
    expect(shows.length === data.runs.length, "not a button for each recorded run");
    shows[shows.length - 1].click();
    motion.shown = replay.names()[0];
    motion.row = shows[shows.length - 1].closest("tr").cells[0].textContent;
    seen.motion = motion;
  }
  seen.needs = byId("motion-needs")?.checkVisibility() ? byId("motion-needs").textContent : "";
  if (window.axe) {
    const found = await axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"] });
    seen.axe = found.passes.length;
    for (const violation of found.violations) {
      const [node] = violation.nodes;
      const why = [...node.any, ...node.all, ...node.none].map((check) => check.message).join("; ");
      faults.push(`axe ${violation.id}: ${node.html.slice(0, 120)}: ${why.slice(0, 200)}`);
    }
  }
  const report = btoa(unescape(encodeURIComponent(JSON.stringify({ faults, seen }))));
  document.body.dataset.probe = report;
  if (parent !== window) parent.postMessage(report, "*");
});
