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
    const name = control.labels?.length ? control.labels[0].textContent : control.textContent;
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
  if (window.axe) {
    const found = await axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"] });
    seen.axe = found.passes.length;
    for (const violation of found.violations) {
      faults.push(`axe ${violation.id}: ${violation.nodes[0].html.slice(0, 120)}`);
    }
  }
  const report = btoa(unescape(encodeURIComponent(JSON.stringify({ faults, seen }))));
  document.body.dataset.probe = report;
  if (parent !== window) parent.postMessage(report, "*");
});
