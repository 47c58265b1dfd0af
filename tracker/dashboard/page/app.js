"use strict";
// Asks for a frame, draws it, asks for the next: a slow browser misses frames, and nobody waits.

const byId = (id) => document.getElementById(id);
const room = new Room(byId("map"));
const STATES = { waiting: "waits", being_served: "is being served", served: "was served", gone: "is gone", ignored: "is ignored" };
let socket = null, state = null, canSteer = false, drawnUrl = null;

function connect() {
  const token = new URLSearchParams(location.search).get("token");
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  socket = new WebSocket(`${scheme}://${location.host}/frames${token ? `?token=${encodeURIComponent(token)}` : ""}`);
  socket.binaryType = "blob";
  socket.onopen = () => { link("live", "ok"); next(); };
  socket.onclose = () => { link("no connection, tries again", "warn"); setTimeout(connect, 1500); };
  socket.onmessage = ({ data }) => {
    if (typeof data !== "string") return picture(data);
    const said = JSON.parse(data);
    if ("can_steer" in said) return hello(said);
    state = said;
    show();
  };
}

const ask = (request) => socket && socket.readyState === WebSocket.OPEN && socket.send(JSON.stringify(request));
const next = () => ask("next");

function link(words, kind) {
  byId("link").textContent = words;
  byId("link").className = `badge ${kind}`;
}

function hello(said) {
  canSteer = said.can_steer;
  byId("title").textContent = said.title;
  byId("settings").hidden = !canSteer;
  if (canSteer) settings(said.parameters);
}

function picture(blob) {
  const url = URL.createObjectURL(blob);
  const image = byId("picture");
  image.onload = image.onerror = () => {
    if (drawnUrl) URL.revokeObjectURL(drawnUrl);
    drawnUrl = url;
    // A page that nobody looks at draws nothing, and asks for little.
    if (document.hidden) setTimeout(next, 1000); else requestAnimationFrame(next);
  };
  image.src = url;
}

function show() {
  const up = state.callers.filter((one) => one.up).map((one) => `#${one.id}`);
  byId("raised").textContent = state.hand_raised ? `hand up: ${up.join(", ") || "somebody"}` : "no hand is up";
  byId("raised").className = `badge ${state.hand_raised ? "up" : ""}`;
  room.draw(state);
  callers(state.callers);
  timeline(state.timeline);
  health(state.health);
  const last = state.said[state.said.length - 1] || "";
  if (byId("said").textContent !== last) byId("said").textContent = last;
}

const duration = (seconds) => {
  const whole = Math.max(0, Math.round(seconds));
  return whole < 60 ? `${whole} s` : `${Math.floor(whole / 60)} min ${whole % 60} s`;
};

// Rows stay as they are while their caller does, so that a button keeps the keyboard's focus.
function callers(list) {
  byId("nobody").hidden = list.length > 0;
  const rows = byId("callers"), old = new Map([...rows.children].map((row) => [row.dataset.id, row]));
  list.forEach((caller, place) => {
    const id = String(caller.id);
    let row = old.get(id);
    old.delete(id);
    if (!row || row.dataset.state !== caller.state) {
      const fresh = rowOf(caller);
      if (row) row.replaceWith(fresh);
      row = fresh;
    }
    if (rows.children[place] !== row) rows.insertBefore(row, rows.children[place] || null);
    row.classList.toggle("selected", caller.selected);
    row.querySelector(".what").textContent = `${STATES[caller.state]}${caller.selected && caller.state === "waiting" ? ", is next" : ""}`;
    row.querySelector("small").textContent =
      `called ${duration(caller.called_s)} ago, ${caller.up ? "hand up" : caller.in_sight ? "in sight" : `out of sight for ${duration(caller.unseen_s)}`}`;
  });
  old.forEach((row) => row.remove());
}

function rowOf(caller) {
  const row = document.createElement("li"), isOpen = ["waiting", "being_served"].includes(caller.state);
  row.dataset.id = caller.id;
  row.dataset.state = caller.state;
  row.classList.toggle("over", !isOpen);
  const number = Object.assign(document.createElement("span"), { className: "number", textContent: `#${caller.id}` });
  const words = Object.assign(document.createElement("span"), { className: "words" });
  words.append(Object.assign(document.createElement("span"), { className: "what" }), document.createElement("small"));
  row.append(number, words);
  if (canSteer && isOpen) {
    const buttons = Object.assign(document.createElement("span"), { className: "buttons" });
    const verbs = caller.state === "waiting" ? ["serve", "ignore"] : ["served", "wait"];
    verbs.forEach((verb, i) => {
      const button = Object.assign(document.createElement("button"), { textContent: verb, className: i ? "" : "main" });
      button.setAttribute("aria-label", `${verb} number ${caller.id}`);
      button.onclick = () => ask({ do: `${verb} ${caller.id}` });
      buttons.append(button);
    });
    row.append(buttons);
  }
  return row;
}

function timeline(lines) {
  const svg = byId("timeline"), reach = 120, width = svg.clientWidth || 600, left = 46, line = 22;
  const numbers = [...new Set(lines.map((one) => one.id))].sort((a, b) => a - b);
  const height = Math.max(1, numbers.length) * line + 22, make = (name, values, words) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(values)) made.setAttribute(key, value);
    if (words) made.textContent = words;
    return made;
  };
  const x = (ago) => left + (1 - Math.min(ago, reach) / reach) * (width - left - 8);
  svg.setAttribute("height", height);
  const parts = [];
  for (let ago = 0; ago <= reach; ago += 30) {
    parts.push(make("line", { x1: x(ago), x2: x(ago), y1: 0, y2: height - 18 }));
    parts.push(make("text", { x: x(ago), y: height - 4, "text-anchor": ago ? "middle" : "end" }, ago ? `-${ago} s` : "now"));
  }
  const shades = { waiting: ["waiting", 4, 6], being_served: ["served", 4, 6], up: ["up", 11, 8] };
  numbers.forEach((id, row) => parts.push(make("text", { x: 2, y: row * line + 15 }, `#${id}`)));
  for (const { id, kind, spans } of lines) {
    if (!shades[kind]) continue;
    const [shade, top, thick] = shades[kind], row = numbers.indexOf(id);
    for (const [from, until] of spans)
      parts.push(make("rect", { x: x(from), y: row * line + top, width: Math.max(2, x(until) - x(from)), height: thick, rx: 2, fill: color(shade) }));
  }
  svg.replaceChildren(...parts);
}

function health(lines) {
  byId("health").replaceChildren(...lines.map(({ name, level, words }) => {
    const line = Object.assign(document.createElement("li"), { className: level });
    line.append(Object.assign(document.createElement("b"), { textContent: name }), words);
    return line;
  }));
}

function settings(parameters) {
  const groups = new Map();
  for (const parameter of parameters) {
    if (!groups.has(parameter.group)) groups.set(parameter.group, []);
    groups.get(parameter.group).push(parameter);
  }
  byId("parameters").replaceChildren(...[...groups].map(([group, list]) => {
    const block = document.createElement("details");
    block.append(Object.assign(document.createElement("summary"), { textContent: group }), ...list.map(control));
    return block;
  }));
  byId("search").oninput = ({ target }) => {
    const wanted = target.value.toLowerCase();
    for (const block of byId("parameters").children) {
      let found = 0;
      for (const line of block.querySelectorAll(".parameter")) {
        line.hidden = !line.textContent.toLowerCase().includes(wanted);
        found += !line.hidden;
      }
      block.hidden = !found;
      block.open = Boolean(wanted);
    }
  };
}

function control(parameter) {
  const line = Object.assign(document.createElement("div"), { className: "parameter" });
  const label = Object.assign(document.createElement("label"), { htmlFor: `p-${parameter.name}` });
  const shown = document.createElement("output");
  const words = (value) => { shown.textContent = `${value} ${parameter.unit}`; };
  label.append(parameter.name, shown);
  let input;
  if (parameter.choices.length) {
    input = document.createElement("select");
    input.append(...parameter.choices.map((choice) => new Option(choice, choice, false, choice === parameter.value)));
    input.onchange = () => ask({ set: [parameter.name, input.value] });
  } else if (typeof parameter.value === "boolean") {
    input = Object.assign(document.createElement("input"), { type: "checkbox", checked: parameter.value });
    input.onchange = () => ask({ set: [parameter.name, input.checked] });
  } else {
    // A slider over what is sensible around the value: ranges reach from 0 to what is absurd.
    const { value, min = 0, max = Infinity } = parameter, most = Math.min(max, Math.max(4 * Math.abs(value), 1));
    const step = parameter.whole ? 1 : 10 ** Math.floor(Math.log10(most / 100));
    const least = Math.max(min, value < 0 ? -most : 0);
    input = Object.assign(document.createElement("input"), { type: "range", min: least, max: most, step: parameter.whole ? 1 : step });
    input.value = value;
    input.oninput = () => words(Number(input.value));
    input.onchange = () => ask({ set: [parameter.name, Number(input.value)] });
    words(value);
  }
  input.id = label.htmlFor;
  line.append(label, input, Object.assign(document.createElement("small"), { textContent: parameter.meaning }));
  return line;
}

connect();
