// The three tests, their answers, and where these are kept.

const KEYS = "123456789abcdefghijklmnopqrstuvwxyz";
const GRADES = ["identical", "slightly different", "different", "very different", "nothing in common"];
const UNDECIDED = "I don’t know";
const TESTS = {
  natural: {
    name: "Real or synthetic?",
    question: "Does this walk seem real or synthetic?",
    about: "Some walks were captured from an actor, who may well exaggerate; others were computed. Say which this seems to be.",
    answers: ["real", "synthetic", UNDECIDED],
  },
  style: {
    name: "Which style?",
    question: "In which style does this figure walk?",
    about: "There are no examples: go by your own idea of each style.",
    answers: [...study.styles, UNDECIDED],
  },
  alike: {
    name: "How alike?",
    question: "How much do these two walks resemble each other?",
    about: "Both are meant to be the same style.",
    answers: GRADES,
  },
};
const STORE = "footfall-study:" + study.id;
const main = document.getElementById("main");
let storeWorks = true, state = load(), player = null, shownAt = 0;

function load() {
  try { return JSON.parse(localStorage.getItem(STORE)); } catch { storeWorks = false; return null; }
}

function save() {
  try { localStorage.setItem(STORE, JSON.stringify(state)); } catch { storeWorks = false; }
}

/** Fisher and Yates, with the browser's own randomness. */
function shuffled(items) {
  const mixed = [...items];
  for (let i = mixed.length - 1; i > 0; i--) {
    const j = Math.floor(crypto.getRandomValues(new Uint32Array(1))[0] / 2 ** 32 * (i + 1));
    [mixed[i], mixed[j]] = [mixed[j], mixed[i]];
  }
  return mixed;
}

function newState() {
  const modes = [true, false];
  const singles = study.clips.flatMap((_, clip) => modes.map((travels) => ({ clips: [clip], travels })));
  const pairs = study.pairs.flatMap((pair) => modes.map((travels) => ({ clips: shuffled(pair), travels })));
  const draw = (test, pool) => shuffled(pool).slice(0, study.trials).map((trial) => ({ test, ...trial }));
  const participant = [...crypto.getRandomValues(new Uint8Array(4))].map((byte) => byte.toString(16).padStart(2, "0")).join("");
  return { participant, trials: [...draw("natural", singles), ...draw("style", singles), ...draw("alike", pairs)], answers: [] };
}

function element(tag, attributes = {}, ...children) {
  const made = Object.assign(document.createElement(tag), attributes);
  made.append(...children);
  return made;
}

const spoken = (name) => name.replaceAll("-", " ").replaceAll("_", " ");

function show(...content) {
  player?.stop();
  player = null;
  main.replaceChildren(...content);
  const done = state ? state.answers.length : 0, all = state ? state.trials.length : 1;
  document.querySelector("#bar div").style.width = 100 * done / all + "%";
  document.getElementById("progress").textContent = "";
  if (!storeWorks) {
    main.append(element("p", { className: "warning", textContent: "This browser keeps no data for this page: do all tests in one go and download the answers at the end." }));
  }
}

function next() {
  if (!state) intro();
  else if (state.answers.length < state.trials.length) trial(state.trials[state.answers.length]);
  else finish();
}

function intro() {
  const begin = element("button", { className: "primary", id: "begin", textContent: "Begin" });
  begin.onclick = () => { state = newState(); save(); next(); };
  const list = element("ol", {}, ...Object.values(TESTS).map((test) => element("li", {}, element("strong", { textContent: test.name }), " " + test.about)));
  show(element("section", { className: "card" },
    element("h2", { textContent: "Watch walks and say what you see" }),
    element("p", { textContent: `Three short tests with up to ${study.trials} walks each, about ten minutes. Start each walk yourself and watch it as often as you like; drag the figure to look from another side.` }),
    list,
    element("p", { textContent: "Your answers stay in this browser until you download them. You can leave and come back." }),
    element("p", { className: "keys", textContent: "Keys: Space plays, ← and → turn the view, the key on a button answers." }),
    begin));
  begin.focus();
}

function trial(now) {
  const test = TESTS[now.test], within = state.trials.filter((one) => one.test === now.test);
  const canvases = now.clips.map(() => element("canvas", { role: "img", ariaLabel: "A walking stick figure" }));
  const stages = element("div", { className: "stages" + (canvases.length > 1 ? " two" : "") },
    ...canvases.map((canvas, i) => element("figure", {}, canvas, ...(canvases.length > 1 ? [element("figcaption", { textContent: "AB"[i] })] : []))));
  const play = element("button", { className: "primary", id: "play" });
  const back = element("button", { className: "quiet", id: "back", textContent: "Back", disabled: state.answers.length === 0 });
  const buttons = test.answers.map((answer, i) => {
    const button = element("button", { disabled: true }, element("kbd", { textContent: KEYS[i] ?? "" }), element("span", { textContent: spoken(answer) }));
    button.dataset.answer = answer;
    button.onclick = () => record(now, answer);
    return button;
  });
  const heading = element("h2", { textContent: test.question, tabIndex: -1 });
  show(heading, element("p", { textContent: test.about, className: "about" }), stages,
    element("div", { className: "controls" }, play, back, element("span", { className: "keys", textContent: "Space plays · ← → turn" })),
    element("div", { className: "answers" + (buttons.length > 6 ? " many" : ""), role: "group", ariaLabel: test.question }, ...buttons));
  document.getElementById("progress").textContent =
    `${test.name} ${within.indexOf(now) + 1} of ${within.length}`;
  player = new Player(canvases.map((canvas, i) => new Stage(canvas, study.clips[now.clips[i]], now.travels)), () => {
    play.textContent = player.playing ? "Pause" : player.plays ? "Play again" : "Play";
    // Nobody judges what was not watched.
    if (player.plays) for (const button of buttons) button.disabled = false;
  });
  player.changed();
  play.onclick = () => player.toggle();
  back.onclick = () => { state.answers.pop(); save(); next(); };
  shownAt = performance.now();
  heading.focus({ preventScroll: true });
  window.scrollTo(0, 0);
}

function record(now, answer) {
  const clips = now.clips.map((clip) => study.clips[clip]);
  const right = now.test === "natural" ? (answer === UNDECIDED ? null : (answer === "real") === (clips[0].source === "real"))
    : now.test === "style" ? answer === clips[0].style : null;
  state.answers.push({
    test: now.test,
    trial: state.answers.length + 1,
    style: clips[0].style,
    source: clips.map((clip) => clip.source).join("|"),
    clip: clips.map((clip) => clip.name).join("|"),
    displacement: now.travels ? "displaced" : "static",
    answer,
    right: right === null ? "" : right ? "yes" : "no",
    grade: now.test === "alike" ? 4 - GRADES.indexOf(answer) : "",
    plays: player.plays,
    seconds: ((performance.now() - shownAt) / 1000).toFixed(1),
    answered_at: new Date().toISOString(),
  });
  save();
  next();
}

function csvText() {
  const columns = ["participant", "study", "test", "trial", "style", "source", "clip", "displacement", "answer", "right", "grade", "plays", "seconds", "answered_at"];
  const field = (value) => /[",\r\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : String(value);
  const rows = state.answers.map((answer) => ({ participant: state.participant, study: study.id, ...answer }));
  return [columns, ...rows.map((row) => columns.map((column) => row[column]))].map((row) => row.map(field).join(",") + "\r\n").join("");
}

function download() {
  const link = element("a", { download: `footfall-study-${state.participant}.csv` });
  link.href = URL.createObjectURL(new Blob([csvText()], { type: "text/csv" }));
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

function finish() {
  const of = (test, source) => state.answers.filter((one) => one.test === test && (!source || one.source === source));
  const share = (answers, holds) => answers.length ? `${answers.filter(holds).length} of ${answers.length}` : "none shown";
  const grades = of("alike").map((one) => one.grade);
  const facts = [
    ["Real walks that you took for real", share(of("natural", "real"), (one) => one.answer === "real")],
    ["Synthetic walks that you took for real", share(of("natural", "synthesised"), (one) => one.answer === "real")],
    ["Styles of real walks recognised", share(of("style", "real"), (one) => one.right === "yes")],
    ["Styles of synthetic walks recognised", share(of("style", "synthesised"), (one) => one.right === "yes")],
    ["Mean resemblance, 0 to 4", grades.length ? (grades.reduce((sum, grade) => sum + grade, 0) / grades.length).toFixed(2) : "none shown"],
  ];
  const save_as = element("button", { className: "primary", id: "download", textContent: "Download answers (CSV)" });
  save_as.onclick = download;
  const again = element("button", { id: "again", textContent: "Start again" });
  again.onclick = () => {
    if (!confirm("Delete these answers and start again?")) return;
    try { localStorage.removeItem(STORE); } catch { storeWorks = false; }
    state = null;
    next();
  };
  show(element("section", { className: "card" },
    element("h2", { textContent: "Thank you", tabIndex: -1 }),
    element("p", { textContent: "Please download your answers and send the file to whoever gave you this page." }),
    element("dl", {}, ...facts.flatMap(([name, value]) => [element("dt", { textContent: name }), element("dd", { textContent: value })])),
    element("div", { className: "row" }, save_as, again)));
  document.getElementById("progress").textContent = "Finished";
  save_as.focus();
}

document.addEventListener("keydown", (event) => {
  if (!player || event.ctrlKey || event.metaKey || event.altKey) return;
  const onButton = document.activeElement?.tagName === "BUTTON";
  if (event.key === " " && !(onButton && document.activeElement.id !== "play")) {
    event.preventDefault();
    player.toggle();
  } else if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
    event.preventDefault();
    player.turn(event.key === "ArrowLeft" ? -0.15 : 0.15);
  } else if (event.key.length === 1 && event.key !== " ") {
    const button = main.querySelectorAll("[data-answer]")[KEYS.indexOf(event.key.toLowerCase())];
    if (button && !button.disabled) { event.preventDefault(); button.click(); }
  }
});

next();
