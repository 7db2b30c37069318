"use strict";
// The page says everything without this script. It adds: sorting and filtering of the table, copying
// of commands, a map that can be zoomed and asked for the ways of one simulation.
(() => {
  const byId = (id) => document.getElementById(id);
  const svgElement = (name, attributes) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    return element;
  };
  const block = byId("data");
  const data = block ? JSON.parse(block.textContent) : { bodies: [], samples: [] };
  const kVerdicts = ["clean", "discrepancy", "lost", "not judged"];
  const kOrigins = ["", "chosen start", "search", "made afterwards"];
  for (const controls of document.querySelectorAll(".controls")) controls.hidden = false;

  // A link to a line of a source opens the text that it is in.
  const openTarget = () => {
    const target = location.hash.length > 1 ? byId(location.hash.slice(1)) : null;
    const details = target && target.closest("details");
    if (details && !details.open) {
      details.open = true;
      target.scrollIntoView();
    }
  };
  addEventListener("hashchange", openTarget);
  openTarget();

  for (const code of document.querySelectorAll("code.command")) {
    const text = code.textContent;
    const button = document.createElement("button");
    button.type = "button";
    button.className = "copy";
    button.textContent = "Copy";
    button.addEventListener("click", async () => {
      try {
        await navigator.clipboard.writeText(text);
        button.textContent = "Copied";
      } catch {
        getSelection().selectAllChildren(code);
        button.textContent = "Selected";
      }
    });
    code.append(button);
  }

  // The table of simulations.
  const table = byId("samples-table");
  const rows = table ? [...table.tBodies[0].rows] : [];
  const firstOf = new Map(data.samples.map(([name], i) => [name, i]));
  const rowOf = { get: (name) => rows[firstOf.get(name)] };
  if (table) {
    let texts = null;  // made when somebody looks for words, as there may be thousands
    const filter = () => {
      const verdict = byId("by-verdict").value, cause = byId("by-cause").value;
      const words = byId("by-text").value.toLowerCase();
      if (words && !texts) texts = rows.map((row) => row.textContent.toLowerCase());
      let shown = 0;
      rows.forEach((row, i) => {
        const fits = (!verdict || row.cells[1].textContent.startsWith(verdict)) &&
          (!cause || row.cells[3].textContent === cause) && (!words || texts[i].includes(words));
        row.hidden = !fits;
        shown += fits ? 1 : 0;
      });
      byId("row-count").textContent = `${shown} of ${rows.length} simulations`;
    };
    for (const id of ["by-verdict", "by-cause", "by-text"]) byId(id).addEventListener("input", filter);
    filter();
    const order = new Map(rows.map((row, i) => [row, i]));
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = head.textContent;
      head.textContent = "";
      head.append(button);
      button.addEventListener("click", () => {
        const down = head.getAttribute("aria-sort") === "ascending";
        for (const other of heads) other.removeAttribute("aria-sort");
        head.setAttribute("aria-sort", down ? "descending" : "ascending");
        const is_number = column >= 4 && column <= 6;
        const key = (row) => column === 0 ? order.get(row)
          : is_number ? Number(row.cells[column].textContent) : row.cells[column].textContent;
        const keyed = rows.map((row) => [key(row), row]);
        keyed.sort(([a, r], [b, s]) => (a < b ? -1 : a > b ? 1 : order.get(r) - order.get(s)));
        if (down) keyed.reverse();
        table.tBodies[0].append(...keyed.map(([, row]) => row));
      });
    });
  }

  // The map.
  const map = byId("map-svg");
  if (!map) return;
  const axis = (text) => {
    const [low, high, from, to] = text.split(" ").map(Number);
    return (value) => from + (value - low) / (high - low) * (to - from);
  };
  const x = axis(map.dataset.x), y = axis(map.dataset.y);
  const whole = map.getAttribute("viewBox").split(" ").map(Number);
  let view = [...whole];
  const hover = byId("map-hover"), says = byId("map-says"), body = byId("map-body");
  let chosen = -1;

  const look = (next) => {
    const size = Math.min(1, Math.max(1 / 40, next[2] / whole[2]));
    view = [0, 0, whole[2] * size, whole[3] * size];
    for (const i of [0, 1]) view[i] = Math.min(Math.max(next[i], 0), whole[i + 2] - view[i + 2]);
    map.setAttribute("viewBox", view.join(" "));
    // Names keep the size that they have on the screen; marks do so by themselves.
    for (const text of map.querySelectorAll("text")) {
      const usual = text.classList.contains("region-name") ? 11 : 12;
      text.setAttribute("font-size", usual * size);
      text.style.fontSize = `${usual * size}px`;
      text.style.strokeWidth = `${3 * size}px`;
    }
    map.dispatchEvent(new Event("view"));
  };
  const zoom = (factor, cx = view[0] + view[2] / 2, cy = view[1] + view[3] / 2) => {
    look([cx - (cx - view[0]) * factor, cy - (cy - view[1]) * factor, view[2] * factor]);
  };
  byId("map-in").addEventListener("click", () => zoom(0.6));
  byId("map-out").addEventListener("click", () => zoom(1 / 0.6));
  byId("map-all").addEventListener("click", () => look(whole));

  const shownBody = () => (body.value === "" ? -1 : Number(body.value));
  body.addEventListener("input", () => {
    for (const element of map.querySelectorAll("[data-body]")) {
      const hides = shownBody() >= 0 && Number(element.dataset.body) !== shownBody();
      element.setAttribute("display", hides ? "none" : "inline");
    }
    map.dispatchEvent(new Event("view"));
    show(-1);
  });

  const show = (index) => {
    hover.replaceChildren();
    for (const row of document.querySelectorAll("tr.chosen")) row.classList.remove("chosen");
    chosen = index;
    if (index < 0) {
      says.textContent = "";
      return;
    }
    const [name, verdict, cause, ways] = data.samples[index];
    ways.forEach((way, i) => {
      if (way.length === 0 || (shownBody() >= 0 && i !== shownBody())) return;
      const points = way.map(([a, b]) => `${x(a).toFixed(1)},${y(b).toFixed(1)}`);
      hover.append(svgElement("polyline", { class: "way hot", points: points.join(" ") }));
      for (const [a, b] of [way[0], way[way.length - 1]]) {
        hover.append(svgElement("path", { class: "dot hot", d: `M${x(a).toFixed(1)} ${y(b).toFixed(1)}h0` }));
      }
    });
    const made = kOrigins[data.samples[index][4]];
    says.textContent =
      `Simulation ${name}: ${kVerdicts[verdict]}${cause ? ", " + cause : ""}${made ? ` (${made})` : ""}`;
    rowOf.get(name)?.classList.add("chosen");
  };

  const nearest = (px, py) => {
    let best = -1, least = (14 * view[2] / map.clientWidth) ** 2;
    data.samples.forEach(([, , , ways], index) => {
      ways.forEach((way, i) => {
        if (way.length === 0 || (shownBody() >= 0 && i !== shownBody())) return;
        for (const [a, b] of [way[0], way[way.length - 1]]) {
          const d = (x(a) - px) ** 2 + (y(b) - py) ** 2;
          if (d < least) [best, least] = [index, d];
        }
      });
    });
    return best;
  };
  const place = (event) => {
    const box = map.getBoundingClientRect();
    return [view[0] + (event.clientX - box.left) / box.width * view[2],
      view[1] + (event.clientY - box.top) / box.height * view[3]];
  };
  let drag = null;
  map.addEventListener("pointermove", (event) => {
    const at = place(event);
    if (drag) {
      look([view[0] - (at[0] - drag[0]), view[1] - (at[1] - drag[1]), view[2]]);
      return;
    }
    const index = nearest(...at);
    if (index !== chosen && index >= 0) show(index);
  });
  map.addEventListener("pointerdown", (event) => { drag = place(event); });
  addEventListener("pointerup", () => { drag = null; });
  map.addEventListener("pointerleave", () => show(-1));
  map.addEventListener("click", () => {
    if (chosen >= 0) rowOf.get(data.samples[chosen][0])?.scrollIntoView({ block: "nearest" });
  });

  // With the keyboard: arrows go through the simulations, plus and minus zoom.
  map.setAttribute("tabindex", "0");
  map.addEventListener("keydown", (event) => {
    const count = data.samples.length;
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (step) {
      show((chosen + step + (chosen < 0 && step < 0 ? 1 : 0) + count) % count);
    } else if (event.key === " ") {
      const next = data.samples.findIndex(([, verdict], i) => i > chosen && verdict === 1);
      show(next >= 0 ? next : data.samples.findIndex(([, verdict]) => verdict === 1));
    } else if (event.key === "+") {
      zoom(0.6);
    } else if (event.key === "-") {
      zoom(1 / 0.6);
    } else if (event.key === "Escape") {
      show(-1);
    } else {
      return;
    }
    event.preventDefault();
  });
})();
