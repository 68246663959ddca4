// A participant made of events: what it gave and what it found goes into <pre id="report">.
(async () => {
  const report = { errors: [], given: [] };
  window.addEventListener("error", (event) => report.errors.push(String(event.message)));
  // A headless browser under virtual time shows few frames; timers it runs as they should.
  window.requestAnimationFrame = (show) => setTimeout(() => show(performance.now()), 16);
  const check = (holds, what) => { if (!holds) report.errors.push(what); };
  const key = (name) => document.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }));
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const all = (selector) => [...document.querySelectorAll(selector)];
  // Figures stand out from the plain stage.
  const drawn = (canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let blue = 0, sum = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 2] - data[i] > 80) { blue += 1; sum += i; }
    }
    return { blue, sum };
  };
  try {
    // Taken as it is made: a blob is read back through another process, which virtual time does not wait for.
    window.Blob = class extends Blob {
      constructor(parts, options) { super(parts, options); report.csv = parts.join(""); }
    };
    HTMLAnchorElement.prototype.click = function () { report.file = this.download; };

    document.getElementById("begin").click();
    let wentBack = false;
    for (let trial = 0; trial < 60 && document.getElementById("play"); trial++) {
      await wait(30);
      const buttons = all("[data-answer]"), canvases = all("canvas");
      check(buttons.every((button) => button.disabled), `trial ${trial}: answers before playing`);
      key("1");
      check(buttons[0].isConnected, `trial ${trial}: answered by key before playing`);
      const before = canvases.map(drawn);
      check(before.every((picture) => picture.blue > 500), `trial ${trial}: no figure ${JSON.stringify(before)}`);
      if (trial % 2) document.getElementById("play").click(); else key(" ");
      await wait(400);
      const during = canvases.map(drawn);
      check(during.every((picture, i) => picture.sum !== before[i].sum), `trial ${trial}: the figure does not move`);
      key(" ");
      await wait(40);
      const paused = canvases.map(drawn);
      key("ArrowRight");
      check(canvases.map(drawn).every((picture, i) => picture.sum !== paused[i].sum), `trial ${trial}: the view does not turn`);
      check(buttons.every((button) => !button.disabled), `trial ${trial}: no answer after playing`);
      const chosen = trial % buttons.length;
      report.given.push(buttons[chosen].dataset.answer);
      if (trial % 3) buttons[chosen].click(); else key(String(chosen + 1));
      check(!buttons[0].isConnected, `trial ${trial}: not answered`);
      if (trial === 2 && !wentBack) {
        wentBack = true;
        document.getElementById("back").click();
        report.given.pop();
      }
    }
    document.getElementById("download").click();
    report.stored = localStorage.getItem("footfall-study:" + study.id);
  } catch (error) {
    report.errors.push(String(error.stack ?? error));
  }
  const pre = document.createElement("pre");
  pre.id = "report";
  pre.textContent = JSON.stringify(report);
  document.body.append(pre);
})();
