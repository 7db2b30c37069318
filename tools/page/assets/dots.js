"use strict";
// Plots of very many simulations: all of their dots, on a canvas over the drawing. Without this
// script the drawing itself has some of them.
(() => {
  const block = document.getElementById("data");
  const plots = [...document.querySelectorAll("svg[data-dots]")];
  if (!block || plots.length === 0) return;
  const { samples } = JSON.parse(block.textContent);
  const kNames = ["clean", "bad", "lost", "open"];
  const kOrder = [0, 3, 2, 1];  // what went wrong comes last, on top

  const axis = (text) => {
    const [low, high, from, to] = text.split(" ").map(Number);
    return (value) => from + (value - low) / (high - low) * (to - from);
  };

  // A dot is drawn once for each kind, and stamped.
  const stampOf = (verdict, isStart, ratio) => {
    const style = getComputedStyle(document.documentElement);
    const color = style.getPropertyValue(`--${kNames[verdict]}`).trim();
    const radius = (verdict === 1 ? 4 : 3) + (isStart ? 1 : 0);
    const side = Math.ceil(2 * (radius + 1) * ratio);
    const stamp = document.createElement("canvas");
    stamp.width = stamp.height = side;
    const pen = stamp.getContext("2d");
    pen.scale(side / (2 * radius + 2), side / (2 * radius + 2));
    pen.translate(radius + 1, radius + 1);
    pen.beginPath();
    const inner = isStart ? radius - 0.9 : radius;
    if (verdict === 1 || verdict === 2) pen.rect(-inner, -inner, 2 * inner, 2 * inner);
    else pen.arc(0, 0, inner, 0, 7);
    pen.fillStyle = pen.strokeStyle = color;
    pen.lineWidth = 1.8;
    if (isStart) pen.stroke();
    else pen.fill();
    return stamp;
  };

  /// The dots of a plot as [x, y, isStart], by simulation.
  const dotsOf = (svg) => {
    const x = axis(svg.dataset.x), y = axis(svg.dataset.y);
    if (svg.dataset.dots === "starts") {
      const u = Number(svg.dataset.u), v = Number(svg.dataset.v), of = svg.dataset.trace;
      return ([name, , , , , start]) => {
        const [trace, number] = name.split(".");
        if (!start || (of && of !== trace)) return [];
        const a = start[u], b = v < 0 ? Number(number) : start[v];
        return a === null || b === null ? [] : [[x(a), y(b), false]];
      };
    }
    const body = document.getElementById("map-body");
    return ([, , , ways]) => ways.flatMap((way, i) => {
      if (way.length === 0 || (body.value !== "" && i !== Number(body.value))) return [];
      const first = way[0], last = way[way.length - 1];
      return [[x(last[0]), y(last[1]), false], [x(first[0]), y(first[1]), true]];
    });
  };

  const draw = (svg, canvas) => {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const { x: left, y: top, width } = svg.viewBox.baseVal;
    canvas.width = Math.max(1, Math.round(svg.clientWidth * ratio));
    canvas.height = Math.max(1, Math.round(svg.clientHeight * ratio));
    const scale = canvas.width / width;
    const pen = canvas.getContext("2d");
    const stamps = kNames.map((_, verdict) => [false, true].map((start) => stampOf(verdict, start, ratio)));
    const dots = dotsOf(svg);
    for (const verdict of kOrder) {
      for (const sample of samples) {
        if (sample[1] !== verdict) continue;
        pen.globalAlpha = sample[4] === 0 ? 0.85 : 0.35;
        for (const [px, py, isStart] of dots(sample)) {
          const stamp = stamps[verdict][isStart ? 1 : 0];
          pen.drawImage(stamp, (px - left) * scale - stamp.width / 2, (py - top) * scale - stamp.height / 2);
        }
      }
    }
  };

  const later = [];
  for (const svg of plots) {
    const canvas = document.createElement("canvas");
    canvas.className = "dots";
    canvas.setAttribute("aria-hidden", "true");
    svg.classList.add("painted");
    svg.after(canvas);
    const again = () => draw(svg, canvas);
    // One after the other, and later, so that the page answers meanwhile.
    setTimeout(() => {
      again();
      let width = svg.clientWidth;
      new ResizeObserver(() => {
        if (svg.clientWidth !== width) again();
        width = svg.clientWidth;
      }).observe(svg);
    });
    svg.addEventListener("view", again);
    later.push(again);
  }
  const all = () => later.forEach((again) => again());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", all);
  addEventListener("beforeprint", all);
})();
