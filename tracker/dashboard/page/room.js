"use strict";
// The room from above: x of the map points up, y to the left. Meters in, pixels out.

const color = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

class Room {
  constructor(canvas) {
    this.canvas = canvas;
    this.bounds = null; // xmin, xmax, ymin, ymax in the map; follows what there is to see, slowly
    this.plan = { number: 0, picture: null }; // the map of the room, fetched once for each
  }

  draw(state) {
    const canvas = this.canvas, dense = window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !height) return;
    canvas.width = Math.round(width * dense);
    canvas.height = Math.round(height * dense);
    const pen = canvas.getContext("2d");
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    this.follow(state);
    const [xmin, xmax, ymin, ymax] = this.bounds;
    const scale = Math.min(width / (ymax - ymin), height / (xmax - xmin));
    const at = (x, y) => [
      width / 2 - (y - (ymin + ymax) / 2) * scale,
      height / 2 - (x - (xmin + xmax) / 2) * scale,
    ];
    this.grid(pen, at, width, height);
    if (state.map) this.map(pen, at, state.map, scale, dense);
    pen.fillStyle = color("soft");
    for (const [x, y] of state.scan) {
      const [left, top] = at(x, y);
      pen.fillRect(left - 1, top - 1, 2, 2);
    }
    if (state.robot) this.robot(pen, at, state.robot, scale);
    for (const caller of state.callers) {
      if (!caller.in_sight && ["waiting", "being_served"].includes(caller.state)) this.lost(pen, at, caller);
    }
    for (const person of state.people) this.person(pen, at, person, scale, state.callers, state.robot);
  }

  // Row and column of the picture run along the map's own axes, which may be turned.
  map(pen, at, { number, origin: [x, y, yaw], pixel_m }, scale, dense) {
    if (this.plan.number !== number) {
      const token = new URLSearchParams(location.search).get("token");
      this.plan = { number, picture: new Image() };
      this.plan.picture.src = `map.png?number=${number}${token ? `&token=${encodeURIComponent(token)}` : ""}`;
    }
    const picture = this.plan.picture;
    if (!picture.complete || !picture.naturalWidth) return;
    const [left, top] = at(x, y), along = pixel_m * scale * Math.cos(yaw), across = pixel_m * scale * Math.sin(yaw);
    pen.save();
    pen.transform(-across, -along, -along, across, left, top);
    pen.imageSmoothingEnabled = pixel_m * scale * dense < 1;
    pen.globalAlpha = .55;
    pen.drawImage(picture, 0, 0);
    pen.restore();
  }

  follow(state) {
    const places = [...state.people.filter((one) => !one.fan), ...state.callers.filter((one) => ["waiting", "being_served"].includes(one.state))];
    const xs = places.map((one) => one.x), ys = places.map((one) => one.y);
    const [x, y] = state.robot || [0, 0];
    for (const [px, py] of state.scan) if (Math.hypot(px - x, py - y) < 6) { xs.push(px); ys.push(py); }
    xs.push(x - 1, x + 2.5); ys.push(y - 2, y + 2);
    const wanted = [Math.min(...xs) - .4, Math.max(...xs) + .4, Math.min(...ys) - .4, Math.max(...ys) + .4];
    this.bounds = this.bounds ? this.bounds.map((old, i) => old + (wanted[i] - old) * .1) : wanted;
  }

  grid(pen, at, width, height) {
    const [xmin, xmax, ymin, ymax] = this.bounds;
    pen.strokeStyle = color("line");
    pen.lineWidth = 1;
    pen.beginPath();
    for (let x = Math.ceil(xmin - 5); x < xmax + 5; x++) { const top = at(x, 0)[1]; pen.moveTo(0, top); pen.lineTo(width, top); }
    for (let y = Math.ceil(ymin - 5); y < ymax + 5; y++) { const left = at(0, y)[0]; pen.moveTo(left, 0); pen.lineTo(left, height); }
    pen.stroke();
    pen.fillStyle = color("soft");
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "left";
    pen.fillText("squares of 1 m", 6, height - 6);
  }

  robot(pen, at, [x, y, yaw], scale) {
    const [left, top] = at(x, y), size = Math.max(.25 * scale, 9);
    pen.save();
    pen.translate(left, top);
    pen.rotate(-yaw);
    pen.fillStyle = color("ink");
    pen.beginPath();
    pen.moveTo(0, -size); pen.lineTo(.7 * size, .8 * size); pen.lineTo(-.7 * size, .8 * size);
    pen.closePath();
    pen.fill();
    pen.restore();
  }

  person(pen, at, person, scale, callers, robot) {
    const shade = color(person.selected ? "selected" : person.up ? "up" : "down");
    const known = callers.find((one) => one.track === person.id);
    const name = `#${known ? known.id : person.id}${person.up ? " up" : ""}`;
    pen.strokeStyle = pen.fillStyle = shade;
    pen.lineWidth = 2;
    if (person.fan && robot) return this.fan(pen, at, person.fan, robot, scale, name, shade);
    const [left, top] = at(person.x, person.y);
    pen.globalAlpha = .5;
    pen.beginPath();
    person.trail.forEach(([x, y], i) => pen[i ? "lineTo" : "moveTo"](...at(x, y)));
    pen.stroke();
    pen.globalAlpha = .18;
    const [long, short, angle] = person.ellipse;
    pen.beginPath();
    pen.ellipse(left, top, Math.max(long * scale, 1), Math.max(short * scale, 1), -angle - Math.PI / 2, 0, 2 * Math.PI);
    pen.fill();
    pen.globalAlpha = 1;
    pen.stroke();
    pen.beginPath();
    pen.arc(left, top, 6, 0, 2 * Math.PI);
    pen.fill();
    this.label(pen, left, top, name, shade);
  }

  // A direction without a distance.
  fan(pen, at, [right, left], [x, y], scale, name, shade) {
    const [across, top] = at(x, y), reach = 2 * scale, middle = (right + left) / 2;
    pen.beginPath();
    pen.moveTo(across, top);
    pen.arc(across, top, reach, -left - Math.PI / 2, -right - Math.PI / 2);
    pen.closePath();
    pen.globalAlpha = .25;
    pen.fill();
    pen.globalAlpha = 1;
    pen.stroke();
    this.label(pen, across - reach * Math.sin(middle), top - reach * Math.cos(middle), name, shade);
  }

  lost(pen, at, caller) {
    const [left, top] = at(caller.x, caller.y);
    pen.strokeStyle = color("soft");
    pen.lineWidth = 2;
    pen.setLineDash([5, 4]);
    pen.beginPath();
    pen.arc(left, top, 12, 0, 2 * Math.PI);
    pen.stroke();
    pen.setLineDash([]);
    this.label(pen, left, top, `#${caller.id}`, color("soft"));
  }

  label(pen, left, top, words, shade) {
    pen.font = "600 14px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.lineWidth = 4;
    pen.strokeStyle = color("card");
    pen.strokeText(words, left, top - 14);
    pen.fillStyle = shade;
    pen.fillText(words, left, top - 14);
  }
}
