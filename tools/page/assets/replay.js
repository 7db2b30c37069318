"use strict";
// Recorded motion in three dimensions, with three.js: one simulation, or one beside another in lock
// step of their events. docs/reference/formats.md has the format of the frames.
// It begins when the page has loaded: what is read first is not to wait for the drawing.
addEventListener("load", () => setTimeout(() => {
  const byId = (id) => document.getElementById(id);
  const section = byId("motion"), block = byId("motion-data"), stage = byId("motion-stage");
  if (!section || !block || !stage) return;
  const needs = byId("motion-needs");
  const data = JSON.parse(block.textContent);
  let renderer = null;
  try {
    const canvas = document.createElement("canvas");
    if (!window.WebGLRenderingContext || !(canvas.getContext("webgl") || canvas.getContext("experimental-webgl"))) throw 0;
    renderer = new THREE.WebGLRenderer({ antialias: true });
  } catch {
    needs.textContent = "Recorded motion is in this page, but this browser has no WebGL to show it with.";
    section.dataset.state = "none";
    return;
  }
  needs.hidden = true;
  byId("motion-box").hidden = false;
  const dark = matchMedia("(prefers-color-scheme: dark)");

  // Frames.

  const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

  /// Times [s] and poses (x y z qw qx qy qz by moving body) of every frame; what is damaged ends it.
  const decode = (run, moving, grippers) => {
    const bytes = bytesOf(run.frames), steps = new Float64Array(moving * 7);
    for (let i = 0; i < moving; ++i) steps[i * 7 + 3] = 4096;
    const grips = new Uint8Array(moving * grippers), out = { times: [], poses: [], grips: [] };
    let at = 0, time = 0;
    const varint = () => {
      let value = 0, scale = 1;
      for (;;) {
        if (at >= bytes.length || scale > 2 ** 56) throw new RangeError();
        const byte = bytes[at++];
        value += (byte & 127) * scale;
        if (byte < 128) return value;
        scale *= 128;
      }
    };
    const change = () => {
      const value = varint();
      return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
    };
    try {
      while (at < bytes.length) {
        time += varint();
        let body = 0;
        for (let left = varint(); left > 0; --left, ++body) {
          body += varint();
          if (body >= moving) throw new RangeError();
          const mask = bytes[at++];
          for (let k = 0; k < 7; ++k) if (mask >> k & 1) steps[body * 7 + k] += change();
        }
        let slot = 0;
        for (let left = varint(); left > 0; --left, ++slot) {
          slot += varint();
          if (slot >= grips.length) throw new RangeError();
          grips[slot] = bytes[at++];
        }
        const poses = new Float32Array(moving * 7);
        for (let i = 0; i < moving; ++i) {
          const q = steps.subarray(i * 7 + 3, i * 7 + 7), norm = Math.hypot(...q) || 1;
          for (let k = 0; k < 3; ++k) poses[i * 7 + k] = steps[i * 7 + k] * 0.0005;
          for (let k = 0; k < 4; ++k) poses[i * 7 + 3 + k] = q[k] / norm;
        }
        out.times.push(time / 1000);
        out.poses.push(poses);
        out.grips.push(grips.slice());
      }
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
    }
    return out;
  };

  // What is seen.

  const kShades = {
    light: { back: "#eef2f6", ground: "#dfe5ec", grid: "#c6d0da", kinds: ["#b9c3cd", "#a98f6f", "#4c6d94", "#2f4a69", "#d9822b", "#6b4fa0"], edge: "#66727f", held: "#1b8a3a", touched: "#8a7a1b", region: "#2f6fd0", reach: "#7a4fd0", sight: "#b08a00" },
    dark: { back: "#141b23", ground: "#1b242e", grid: "#2c3947", kinds: ["#56636f", "#8a7458", "#7fa6d6", "#a9c4e6", "#f0a04b", "#b69be6"], edge: "#8796a5", held: "#4ade80", touched: "#e6d44c", region: "#6aa5ff", reach: "#b794ff", sight: "#f0c94b" },
  };
  const shades = () => dark.matches ? kShades.dark : kShades.light;

  const put = (object, pose, at = 0) => {
    object.position.set(pose[at], pose[at + 1], pose[at + 2]);
    object.quaternion.set(pose[at + 4], pose[at + 5], pose[at + 6], pose[at + 3]);
    return object;
  };

  /// Triangles with corners of their own, so that each face has one shade.
  const hullOf = ({ corners, faces }) => {
    const places = [];
    for (const face of faces) for (const corner of face) places.push(...corners[corner]);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(places), 3));
    geometry.computeVertexNormals();
    return geometry;
  };

  const geometriesOf = (shape) => {
    const { kind, size: [a, b, c] } = shape;
    if (kind === 4) return [[hullOf(shape), 0]];
    if (kind === 0) return [[new THREE.BoxBufferGeometry(a, b, c), 0]];
    if (kind === 1) return [[new THREE.SphereBufferGeometry(a, 24, 16), 0]];
    const tube = new THREE.CylinderBufferGeometry(a, a, b, 28);
    tube.rotateX(Math.PI / 2);
    if (kind === 2) return [[tube, 0]];
    return [[tube, 0], [new THREE.SphereBufferGeometry(a, 20, 12), b / 2], [new THREE.SphereBufferGeometry(a, 20, 12), -b / 2]];
  };

  const bodyOf = (body, shade) => {
    const group = new THREE.Group();
    group.name = body.name;
    const fill = new THREE.MeshLambertMaterial({ color: body.colour || shade.kinds[body.kind] });
    const line = new THREE.LineBasicMaterial({ color: shade.edge, transparent: true, opacity: 0.55 });
    for (const shape of body.shapes) {
      const part = put(new THREE.Group(), shape.pose);
      // What is as large as the ground hides what lies on it: it is drawn as ground.
      const isGround = body.kind === 0 && shape.kind === 0 && shape.size[0] > 30;
      if (isGround) continue;
      for (const [geometry, z] of geometriesOf(shape)) {
        const mesh = new THREE.Mesh(geometry, fill);
        mesh.position.z = z;
        part.add(mesh);
        if (shape.kind === 0 || shape.kind === 4) part.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry), line));
      }
      group.add(part);
    }
    group.userData.fill = fill;
    return group;
  };

  /// One simulation in a scene of its own.
  class Play {
    constructor(run) {
      this.run = run;
      this.spec = data.scenes[run.scene];
      this.moving = [];
      this.spec.bodies.forEach((body, i) => { if (body.moves && body.on === undefined) this.moving.push(i); });
      Object.assign(this, decode(run, this.moving.length, this.spec.grippers.length));
      const last = run.events[run.events.length - 1];
      this.end = Math.max(this.times[this.times.length - 1] || 0, last ? last.end : 0);
      this.indexOf = new Map(this.moving.map((body, i) => [body, i]));
      this.build();
    }

    build() {
      const shade = shades();
      this.scene = new THREE.Scene();
      this.scene.background = new THREE.Color(shade.back);
      this.scene.add(new THREE.HemisphereLight("#ffffff", dark.matches ? "#5a6673" : "#b8c2cc", dark.matches ? 0.72 : 0.72));
      const sun = new THREE.DirectionalLight("#ffffff", 0.4);
      sun.position.set(-3, -5, 8);
      this.scene.add(sun);
      this.groups = this.spec.bodies.map((body) => bodyOf(body, shade));
      this.spec.bodies.forEach((body, i) => {
        put(this.groups[i], body.pose);
        (body.on === undefined ? this.scene : this.groups[body.on]).add(this.groups[i]);
      });
      this.box = this.bounds();
      const size = this.box.getSize(new THREE.Vector3()), middle = this.box.getCenter(new THREE.Vector3());
      const side = Math.ceil(Math.max(size.x, size.y) + 3);
      const ground = new THREE.Mesh(new THREE.PlaneBufferGeometry(side, side), new THREE.MeshLambertMaterial({ color: shade.ground }));
      ground.position.set(middle.x, middle.y, -0.004);
      const grid = new THREE.GridHelper(side, side * 2, shade.grid, shade.grid);
      grid.rotation.x = Math.PI / 2;
      grid.position.set(middle.x, middle.y, -0.002);
      this.scene.add(ground, grid);
      this.addRegions(shade);
      this.addArms(shade);
      this.addReach(shade);
      this.addSight(shade);
    }

    /// Everything that moves, wherever it gets to, and what stands near it.
    bounds() {
      const box = new THREE.Box3();
      for (const poses of this.poses) {
        for (let i = 0; i < this.moving.length; ++i) {
          box.expandByPoint(new THREE.Vector3(poses[i * 7], poses[i * 7 + 1], poses[i * 7 + 2]));
        }
      }
      if (box.isEmpty()) box.expandByPoint(new THREE.Vector3(0, 0, 0));
      const near = box.clone().expandByScalar(1.0);
      this.spec.bodies.forEach((body, i) => {
        if (body.moves) return;
        const own = new THREE.Box3().setFromObject(this.groups[i]);
        if (!own.isEmpty() && near.intersectsBox(own) && own.getSize(new THREE.Vector3()).length() < 12) box.union(own.intersect(near));
      });
      return box.expandByScalar(0.25);
    }

    addRegions(shade) {
      this.regions = [];
      for (const region of data.regions) {
        const body = region.body ? this.spec.bodies.findIndex((one) => one.name === region.body) : -1;
        const lows = [this.box.min.x, this.box.min.y, 0], highs = [this.box.max.x, this.box.max.y, 0.02];
        const low = [], high = [];
        [region.x, region.y, region.z].forEach((bound, k) => {
          const from = bound ? Math.max(bound[0], lows[k] - 4) : lows[k];
          low.push(from);
          high.push(bound ? Math.max(Math.min(bound[1], k === 2 ? from + 0.6 : highs[k] + 4), from + 0.004) : highs[k]);
        });
        const geometry = new THREE.BoxBufferGeometry(...low.map((from, k) => high[k] - from));
        const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ color: shade.region, transparent: true, opacity: 0.1, depthWrite: false }));
        const lines = new THREE.LineSegments(new THREE.EdgesGeometry(geometry), new THREE.LineBasicMaterial({ color: shade.region, transparent: true, opacity: 0.7 }));
        const group = new THREE.Group();
        group.add(mesh, lines);
        group.position.set(...low.map((from, k) => (from + high[k]) / 2 - (body >= 0 ? region.start[k] : 0)));
        (body >= 0 ? this.groups[body] : this.scene).add(group);
        this.regions.push(group);
      }
    }

    /// A line for each arm: what the simulator has between shoulder and hand is not known.
    addArms(shade) {
      this.arms = this.spec.arms.map((arm) => {
        const bar = new THREE.Mesh(new THREE.CylinderBufferGeometry(0.025, 0.025, 1, 12),
          new THREE.MeshLambertMaterial({ color: shade.kinds[3] }));
        this.scene.add(bar);
        return bar;
      });
    }

    placeArms() {
      this.spec.arms.forEach((arm, i) => {
        const from = this.groups[arm.from].localToWorld(new THREE.Vector3(...arm.shoulder));
        const along = this.groups[arm.to].getWorldPosition(new THREE.Vector3()).sub(from), bar = this.arms[i];
        bar.position.copy(from).addScaledVector(along, 0.5);
        bar.scale.set(1, Math.max(along.length(), 1e-3), 1);
        bar.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
      });
    }

    addReach(shade) {
      this.reach = [];
      for (const arm of this.spec.arms) {
        if (!(arm.reach[1] > 0) || !this.groups[arm.from]) continue;
        const group = new THREE.Group();
        group.position.set(...arm.shoulder);
        group.add(new THREE.Mesh(new THREE.SphereBufferGeometry(arm.reach[1], 32, 20),
          new THREE.MeshBasicMaterial({ color: shade.reach, transparent: true, opacity: 0.1, depthWrite: false, side: THREE.DoubleSide })));
        const ring = new THREE.EdgesGeometry(new THREE.CircleBufferGeometry(arm.reach[1], 64));
        group.add(new THREE.LineSegments(ring, new THREE.LineBasicMaterial({ color: shade.reach })));
        this.groups[arm.from].add(group);
        this.reach.push(group);
      }
    }

    addSight(shade) {
      this.sight = [];
      if (!this.spec.camera) return;
      const [angle, near, far] = this.spec.camera;
      const long = Math.min(far || 2, 3), wide = Math.tan(Math.min(angle, 1.4)) * long;
      this.spec.bodies.forEach((body, i) => {
        if (body.kind !== 5) return;
        const cone = new THREE.ConeBufferGeometry(wide, long, 32, 1, true);
        cone.translate(0, -long / 2, 0);
        cone.rotateZ(Math.PI / 2);
        const mesh = new THREE.Mesh(cone, new THREE.MeshBasicMaterial({ color: shade.sight, transparent: true, opacity: 0.13, depthWrite: false, side: THREE.DoubleSide }));
        this.groups[i].add(mesh);
        this.sight.push(mesh);
      });
    }

    /// Bodies as they were at a time: between two frames between their places. Where nothing was
    /// written for long, all stood still until shortly before.
    show(time) {
      let high = this.times.length - 1, low = 0;
      if (high < 0) return;
      while (low < high) {
        const middle = low + high + 1 >> 1;
        if (this.times[middle] <= time) low = middle;
        else high = middle - 1;
      }
      const next = Math.min(low + 1, this.times.length - 1);
      const until = this.times[next], from = Math.max(this.times[low], until - 1.5 * (this.run.interval || 0.1));
      const share = next === low ? 0 : Math.min(1, Math.max(0, (time - from) / (until - from || 1)));
      const target = new THREE.Quaternion();
      this.moving.forEach((body, i) => {
        const group = put(this.groups[body], this.poses[low], i * 7), to = this.poses[next], k = i * 7;
        if (share === 0) return;
        group.position.lerp(new THREE.Vector3(to[k], to[k + 1], to[k + 2]), share);
        group.quaternion.slerp(target.set(to[k + 4], to[k + 5], to[k + 6], to[k + 3]), share);
      });
      this.held = [];
      const shade = shades(), count = this.spec.grippers.length;
      this.moving.forEach((body, i) => {
        let grip = 0;
        for (let g = 0; g < count; ++g) {
          const bits = this.grips[low][i * count + g];
          grip |= bits;
          if (bits & 4) this.held.push(`${this.spec.grippers[g]} holds ${this.spec.bodies[body].name}`);
        }
        const fill = this.groups[body].userData.fill;
        fill.emissive.set(grip & 4 ? shade.held : grip & 3 ? shade.touched : "#000000");
        fill.emissiveIntensity = grip & 7 ? 0.55 : 0;
      });
    }

    eventAt(time) {
      const { events } = this.run;
      for (let i = events.length - 1; i >= 0; --i) if (time >= events[i].begin) return i;
      return -1;
    }
  }

  // Time: that of the first simulation; the one beside it is at the same share of the same event.

  let plays = [], time = 0, playing = false, speed = 1, before = 0;
  const inStep = (play, lead, now) => {
    if (play === lead) return now;
    const i = lead.eventAt(now);
    const of = lead.run.events[i], to = play.run.events[i];
    if (!of || !to) return i < 0 ? 0 : play.end;
    const share = of.end > of.begin ? Math.min(1, (now - of.begin) / (of.end - of.begin)) : 1;
    return to.begin + share * (to.end - to.begin);
  };

  // The view: turned about a point that may follow a body.

  const camera = new THREE.PerspectiveCamera(38, 1, 0.02, 200);
  camera.up.set(0, 0, 1);
  const look = { at: new THREE.Vector3(), azimuth: -1.9, height: 0.5, far: 5 };
  const clock = byId("motion-clock"), slider = byId("motion-time"), says = byId("motion-says");
  const follow = byId("motion-follow"), list = byId("motion-events"), button = byId("motion-play");
  const chosen = { run: byId("motion-run"), beside: byId("motion-beside") };

  const place = () => {
    const body = follow.value === "" ? null : plays[0].groups[Number(follow.value)];
    const at = look.at.clone();
    if (body) body.getWorldPosition(at);
    const flat = Math.cos(look.height) * look.far;
    camera.position.set(at.x + flat * Math.cos(look.azimuth), at.y + flat * Math.sin(look.azimuth), at.z + Math.sin(look.height) * look.far);
    camera.lookAt(at);
  };

  const kThing = 4;  // what can be carried, among the kinds of bodies

  /// How many of the things that are handled can be seen at the beginning and at the end, from one side.
  const seenFrom = (azimuth) => {
    const away = new THREE.Vector3(Math.cos(0.55) * Math.cos(azimuth), Math.cos(0.55) * Math.sin(azimuth), Math.sin(0.55));
    const camera_W = look.at.clone().addScaledVector(away, look.far), ray = new THREE.Raycaster();
    let seen = 0;
    for (const play of plays) {
      const bodies = play.spec.bodies;
      for (const at of [0, play.end]) {
        play.show(at);
        play.scene.updateMatrixWorld();
        const meshes = play.groups.flatMap((group) => group.children.flatMap((part) => part.children.filter((one) => one.isMesh)));
        for (const i of play.moving.filter((body) => bodies[body].kind === kThing)) {
          const thing_W = play.groups[i].getWorldPosition(new THREE.Vector3());
          ray.set(camera_W, thing_W.sub(camera_W).normalize());
          const first = ray.intersectObjects(meshes)[0];
          if (first && first.object.parent.parent === play.groups[i]) ++seen;
        }
      }
    }
    return seen;
  };

  /// The side from which most things can be seen; the usual one where others show no more.
  const openSide = () => {
    const usual = -2.0, turns = [0, 0.7, -0.7, 1.4, -1.4, 2.1, -2.1, Math.PI];
    const sides = turns.map((turn) => [usual + turn, seenFrom(usual + turn)]);
    return sides.reduce((best, side) => side[1] > best[1] ? side : best)[0];
  };

  const view = (name) => {
    const box = plays.reduce((all, play) => all.union(play.box), new THREE.Box3());
    const size = box.getSize(new THREE.Vector3());
    box.getCenter(look.at);
    look.far = Math.max(size.x, size.y, 1.2) * (plays.length > 1 ? 1.45 : 1.15);
    if (name === "top") [look.azimuth, look.height] = [-Math.PI / 2, Math.PI / 2 - 0.001];
    else if (name === "front") [look.azimuth, look.height] = [-Math.PI / 2, 0.12];
    else [look.azimuth, look.height] = [name === "world" ? openSide() : -2.0, 0.55];
    if (name === "robot") {
      const robot = plays[0].spec.bodies.findIndex((body) => body.moves && body.on === undefined && body.kind === 2);
      if (robot >= 0) {
        follow.value = String(robot);
        look.far = 3.2;
      }
    } else {
      follow.value = "";
    }
    draw();
  };

  const draw = () => {
    const wide = stage.clientWidth, high = stage.clientHeight;
    if (plays.length === 0 || wide === 0) return;
    plays.forEach((play) => {
      play.show(inStep(play, plays[0], time));
      play.regions.forEach((one) => { one.visible = byId("motion-regions").checked; });
      play.reach.forEach((one) => { one.visible = byId("motion-reach").checked; });
      play.sight.forEach((one) => { one.visible = byId("motion-sight").checked; });
      play.scene.updateMatrixWorld();
      play.placeArms();
    });
    place();
    const each = wide / plays.length;
    camera.aspect = each / high;
    camera.updateProjectionMatrix();
    renderer.setScissorTest(true);
    plays.forEach((play, i) => {
      renderer.setViewport(i * each, 0, each, high);
      renderer.setScissor(i * each, 0, each - (i + 1 < plays.length ? 2 : 0), high);
      renderer.render(play.scene, camera);
    });
    tell();
  };

  const three = (value) => Number(value).toPrecision(3);
  const tell = () => {
    const lead = plays[0], i = lead.eventAt(time), event = lead.run.events[i];
    slider.value = String(time);
    slider.setAttribute("aria-valuetext", `${time.toFixed(1)} s${event ? `, ${event.name}` : ""}`);
    clock.textContent = `${time.toFixed(1)} of ${lead.end.toFixed(1)} s`;
    [...list.children].forEach((item, k) => item.classList.toggle("now", k === i));
    const parts = [];
    if (event) {
      const isOver = time >= event.end - 2e-4;
      parts.push(`${i} ${event.name}${isOver ? `: ${event.status}${event.reason ? ` (${event.reason})` : ""}` : ""}`);
      for (const [name, value] of event.margins) parts.push(`${name} ${three(value)}`);
    }
    for (const arm of lead.spec.arms) {
      if (!(arm.reach[1] > 0)) continue;
      const shoulder = lead.groups[arm.from].localToWorld(new THREE.Vector3(...arm.shoulder));
      const hand = lead.groups[arm.to].getWorldPosition(new THREE.Vector3());
      parts.push(`${arm.name} ${three(shoulder.distanceTo(hand))} of ${three(arm.reach[1])} m`);
    }
    parts.push(...lead.held);
    if (lead.run.missing) parts.push(`motion is missing: ${lead.run.missing}`);
    says.textContent = parts.join(" \u00b7 ").replaceAll("`", "");
  };

  const kMoment = 1e-4;
  const seek = (next) => {
    time = Math.min(Math.max(next, 0), plays[0].end);
    draw();
  };
  const goTo = (i) => {
    const event = plays[0].run.events[i];
    // The next one begins when this one ends.
    if (event) seek(event.end - (i + 1 < plays[0].run.events.length ? kMoment : 0));
  };
  const run = (now) => {
    if (!playing) return;
    const next = time + (now - before) / 1000 * speed;
    before = now;
    if (next >= plays[0].end) play(false);
    seek(next);
    requestAnimationFrame(run);
  };
  const play = (on) => {
    playing = on;
    button.textContent = on ? "Pause" : "Play";
    if (!on) return;
    if (time >= plays[0].end) time = 0;
    before = performance.now();
    requestAnimationFrame(run);
  };

  const size = () => {
    renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    renderer.setSize(stage.clientWidth, stage.clientHeight, false);
    draw();
  };

  const fill = () => {
    const lead = plays[0];
    slider.max = String(lead.end);
    list.replaceChildren(...lead.run.events.map((event, i) => {
      const item = document.createElement("li"), go = document.createElement("button");
      go.type = "button";
      go.textContent = `${i} ${event.name}`;
      if (event.status !== "ok") go.textContent += ` ${event.status}`;
      if (lead.run.parting === i) {
        item.className = "parts";
        go.textContent += " \u2013 they part here";
      }
      go.addEventListener("click", () => goTo(i));
      item.append(go);
      return item;
    }));
    const kept = follow.value;
    follow.replaceChildren(new Option("nothing", ""));
    lead.moving.forEach((i) => follow.add(new Option(lead.spec.bodies[i].name, String(i))));
    follow.value = [...follow.options].some((one) => one.value === kept) ? kept : "";
    stage.querySelectorAll(".name").forEach((one) => one.remove());
    plays.forEach((one, i) => {
      const name = document.createElement("span");
      name.className = `name ${one.run.verdict === "clean" ? "clean" : one.run.verdict === "discrepancy" ? "bad" : "open"}`;
      name.textContent = `${one.run.name} ${one.run.verdict}`;
      name.style.left = `${100 * i / plays.length}%`;
      stage.append(name);
    });
  };

  const choose = (index, beside) => {
    play(false);
    chosen.run.value = String(index);
    chosen.beside.value = beside === undefined || beside === index ? "" : String(beside);
    plays = [new Play(data.runs[index])];
    if (chosen.beside.value !== "") plays.push(new Play(data.runs[Number(chosen.beside.value)]));
    time = 0;
    fill();
    view("world");
  };

  stage.prepend(renderer.domElement);
  renderer.domElement.setAttribute("aria-hidden", "true");
  chosen.run.addEventListener("input", () => choose(Number(chosen.run.value), data.runs[Number(chosen.run.value)].beside));
  chosen.beside.addEventListener("input", () => choose(Number(chosen.run.value), chosen.beside.value === "" ? undefined : Number(chosen.beside.value)));
  for (const id of ["motion-regions", "motion-reach", "motion-sight", "motion-follow"]) byId(id).addEventListener("input", draw);
  for (const one of section.querySelectorAll("[data-view]")) one.addEventListener("click", () => view(one.dataset.view));
  byId("motion-speed").addEventListener("input", (event) => { speed = Number(event.target.value); });
  slider.addEventListener("input", () => { play(false); seek(Number(slider.value)); });
  button.addEventListener("click", () => play(!playing));

  const turn = (dx, dy) => {
    look.azimuth -= dx;
    look.height = Math.min(Math.PI / 2 - 0.001, Math.max(-0.2, look.height + dy));
    draw();
  };
  const zoom = (factor) => {
    look.far = Math.min(60, Math.max(0.3, look.far * factor));
    draw();
  };
  stage.addEventListener("keydown", (event) => {
    const now = plays[0].eventAt(time), frame = plays[0].run.interval || 0.1;
    const acts = {
      " ": () => play(!playing),
      ArrowRight: () => goTo(now >= 0 && time < plays[0].run.events[now].end - 2e-4 ? now : now + 1),
      ArrowLeft: () => (now > 0 ? goTo(now - 1) : seek(0)),
      ",": () => seek(time - frame), ".": () => seek(time + frame),
      ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
      "+": () => zoom(0.8), "-": () => zoom(1.25),
    };
    const act = acts[event.key];
    if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (event.key !== " ") play(false);
    act();
  });
  let drag = null;
  stage.addEventListener("pointerdown", (event) => {
    drag = [event.clientX, event.clientY];
    stage.setPointerCapture(event.pointerId);
  });
  stage.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const dx = event.clientX - drag[0], dy = event.clientY - drag[1];
    drag = [event.clientX, event.clientY];
    if (!event.shiftKey) return turn(dx * 0.008, dy * 0.008);
    follow.value = "";
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0), up = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1);
    const scale = look.far / stage.clientHeight * 0.7;
    look.at.addScaledVector(right, -dx * scale).addScaledVector(up, dy * scale);
    draw();
  });
  stage.addEventListener("pointerup", () => { drag = null; });
  stage.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return;  // else the page is scrolled
    event.preventDefault();
    zoom(Math.exp(event.deltaY * 0.002));
  }, { passive: false });
  dark.addEventListener("change", () => { plays.forEach((one) => one.build()); draw(); });
  new ResizeObserver(size).observe(stage);

  // The table of simulations leads here.
  const table = byId("samples-table");
  const names = new Map(data.runs.map((one, i) => [one.name, i]));
  for (const row of table ? table.tBodies[0].rows : []) {
    const name = row.cells[0].textContent, index = names.get(name);
    if (index === undefined) continue;
    const show = document.createElement("button");
    show.type = "button";
    show.className = "show";
    show.textContent = "Show";
    show.setAttribute("aria-label", `Show the motion of ${name}`);
    show.addEventListener("click", () => {
      choose(index, data.runs[index].beside);
      section.scrollIntoView();
      stage.focus({ preventScroll: true });
    });
    row.cells[row.cells.length - 1].append(show);
  }

  choose(0, data.runs[0].beside);
  if (data.runs[0].parting !== undefined) goTo(data.runs[0].parting);
  section.dataset.state = "ready";
  // For whoever looks at a page with a program: what is drawn, and when.
  section.replay = {
    seek, choose, draw, canvas: renderer.domElement,
    time: () => time, playing: () => playing, names: () => plays.map((one) => one.run.name),
    poseOf: (name, beside = 0) => {
      const group = plays[beside].groups.find((one) => one.name === name);
      const p = group.getWorldPosition(new THREE.Vector3()), q = group.getWorldQuaternion(new THREE.Quaternion());
      return [p.x, p.y, p.z, q.w, q.x, q.y, q.z];
    },
  };
}));
