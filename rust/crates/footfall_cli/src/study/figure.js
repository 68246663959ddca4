"use strict";
// A stick figure on a canvas: a player for one clip, or for two that run together.

const study = JSON.parse(document.getElementById("study").textContent);

/** Metres of every point in every frame: frames × points × 3. */
function decode(clip) {
  if (!clip.points) {
    const bytes = Uint8Array.from(atob(clip.data), (letter) => letter.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    clip.points = Float32Array.from({ length: bytes.length / 2 }, (_, i) => view.getInt16(2 * i, true) / 1000);
  }
  return clip.points;
}

class Stage {
  constructor(canvas, clip, travels) {
    Object.assign(this, { canvas, clip, travels, yaw: 0.9, time: 0 });
    decode(clip);
    this.drags(canvas);
    this.draw();
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  get seconds() { return (this.clip.frames - 1) / study.fps; }

  drags(canvas) {
    let from = null;
    canvas.addEventListener("pointerdown", (event) => { from = event.clientX; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointermove", (event) => {
      if (from === null) return;
      this.turn((event.clientX - from) * 0.01);
      from = event.clientX;
    });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => { from = null; });
  }

  turn(by) { this.yaw += by; this.draw(); }

  /** Position of a point at the current time, where the study shows it. */
  place(point, root, target) {
    const width = study.points * 3, position = Math.min(this.time, this.seconds) * study.fps;
    const frame = Math.min(Math.floor(position), this.clip.frames - 1), next = Math.min(frame + 1, this.clip.frames - 1);
    const share = position - frame, points = this.clip.points;
    const at = (axis) => {
      const from = points[frame * width + point * 3 + axis];
      return from + share * (points[next * width + point * 3 + axis] - from);
    };
    const shift = this.travels ? target : root;
    return [at(0) - shift[0], at(1), at(2) - shift[2]];
  }

  draw() {
    const scale = window.devicePixelRatio || 1, canvas = this.canvas;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !height) return;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    const pen = canvas.getContext("2d");
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    const css = getComputedStyle(document.documentElement), colour = (name) => css.getPropertyValue("--" + name).trim();

    // The camera goes along at the clip's mean velocity, so that the walker's own unevenness stays visible.
    const last = (this.clip.frames - 1) * study.points * 3, share = Math.min(this.time / this.seconds, 1);
    const target = [0, 1, 2].map((axis) => {
      const from = this.clip.points[axis];
      return from + share * (this.clip.points[last + axis] - from);
    });
    const root = this.place(0, [0, 0, 0], [0, 0, 0]);
    const sine = Math.sin(this.yaw), cosine = Math.cos(this.yaw), tilt = 0.16, distance = 6.5;
    const size = Math.min(height / 2.15, width / 1.4);
    const project = ([x, y, z]) => {
      const side = x * cosine - z * sine, depth = x * sine + z * cosine;
      const up = (y - 0.88) * Math.cos(tilt) - depth * Math.sin(tilt);
      const near = distance / (distance - depth * Math.cos(tilt));
      return { x: width / 2 + side * near * size, y: height * 0.5 - up * near * size, depth, near };
    };
    this.floor(pen, { width, height, colour, project, target });
    // Limb by limb from far to near, each with one rim around it as a whole.
    const limbs = new Map();
    for (const [from, to, thickness, limb] of study.parts) {
      const a = project(this.place(from, root, target)), b = project(this.place(to, root, target));
      if (!limbs.has(limb)) limbs.set(limb, []);
      limbs.get(limb).push({ a, b, line: thickness * size * (a.near + b.near) / 2 });
    }
    const [neck, top] = study.head.map((point) => project(this.place(point, root, target)));
    limbs.get("trunk").push({ a: neck, b: top, head: true });
    const depth = (parts) => parts.reduce((sum, part) => sum + part.a.depth + part.b.depth, 0) / parts.length;
    const ordered = [...limbs].sort((one, other) => depth(one[1]) - depth(other[1]));
    pen.lineCap = "round";
    for (const [limb, parts] of ordered) {
      for (const rim of [4, 0]) {
        pen.strokeStyle = pen.fillStyle = rim ? colour("stage-top") : colour(limb.split(" ")[0]);
        for (const part of parts) {
          pen.beginPath();
          if (part.head) {
            pen.arc((part.a.x + part.b.x) / 2, (part.a.y + part.b.y) / 2, 0.105 * size * part.a.near + rim / 2, 0, 7);
            pen.fill();
          } else {
            pen.lineWidth = part.line + rim;
            pen.moveTo(part.a.x, part.a.y);
            pen.lineTo(part.b.x, part.b.y);
            pen.stroke();
          }
        }
      }
    }
  }

  floor(pen, { width, height, colour, project, target }) {
    pen.fillStyle = colour("stage-top");
    pen.fillRect(0, 0, width, height);
    pen.fillStyle = colour("stage-floor");
    pen.beginPath();
    for (let i = 0; i < 48; i++) {
      const spot = project([1.5 * Math.cos(i * Math.PI / 24), 0, 1.5 * Math.sin(i * Math.PI / 24)]);
      pen.lineTo(spot.x, spot.y);
    }
    pen.fill();
    if (!this.travels) return;
    // Lines on the floor show the travel; without it there are none to slide over.
    pen.save();
    pen.clip();
    pen.strokeStyle = colour("grid");
    pen.lineWidth = 1;
    const gap = 0.5, rest = (value) => ((value % gap) + gap) % gap;
    for (let i = -4; i <= 4; i++) {
      const x = i * gap - rest(target[0]), z = i * gap - rest(target[2]);
      for (const [from, to] of [[[x, 0, -2], [x, 0, 2]], [[-2, 0, z], [2, 0, z]]]) {
        const a = project(from), b = project(to);
        pen.beginPath();
        pen.moveTo(a.x, a.y);
        pen.lineTo(b.x, b.y);
        pen.stroke();
      }
    }
    pen.restore();
  }
}

class Player {
  constructor(stages, changed) {
    Object.assign(this, { stages, changed, playing: false, plays: 0, time: 0 });
    this.seconds = Math.max(...stages.map((stage) => stage.seconds));
  }

  toggle() {
    if (this.playing) { this.playing = false; this.changed(); return; }
    if (this.time >= this.seconds) this.time = 0;
    if (this.time === 0) this.plays += 1;
    this.playing = true;
    this.changed();
    let before = null;
    const tick = (now) => {
      if (!this.playing) return;
      if (before !== null) this.time = Math.min(this.time + (now - before) / 1000, this.seconds);
      before = now;
      for (const stage of this.stages) { stage.time = this.time; stage.draw(); }
      if (this.time >= this.seconds) { this.playing = false; this.changed(); } else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  stop() { this.playing = false; }
  turn(by) { for (const stage of this.stages) stage.turn(by); }
}
