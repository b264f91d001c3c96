/** The arm, the wall and the forces at the present time of the run, in three dimensions. */
import { AmbientLight, Color, DirectionalLight, Scene as Space, WebGLRenderer } from "three";
import { colours } from "../app/colours.js";
import { at } from "../app/dom.js";
import { later, show } from "../app/frames.js";
import { fixed, shown } from "../app/numbers.js";
import { ArmModel } from "./arm.js";
import { captions } from "./captions.js";
import { Forces } from "./forces.js";
import { floorOf, pointsOf } from "./framing.js";
import { Ghost } from "./ghost.js";
import { Ground } from "./ground.js";
import { JointAxes } from "./joint_axes.js";
import { Labels } from "./labels.js";
import { Plate } from "./plate.js";
import { plateSize, poseAt, unit, wallFrame } from "./pose.js";
import { Trace } from "./trace.js";
import { View } from "./view.js";

const OVER = ["views", "legend", "energies"]; // ids of what stands over the scene

export class Scene {
  /** Throws an Error where the browser has no WebGL. */
  constructor(store) {
    this.store = store;
    this.canvas = at("scene-canvas");
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, preserveDrawingBuffer: false });
    this.renderer.debug.checkShaderErrors = false; // asking for them waits for the graphics driver
    this.space = new Space();
    this.view = new View(this.canvas, () => this.draw());
    this.labels = new Labels(at("scene-labels"), OVER.map(at));
    this.handles = [];
    this.parts = { arm: new ArmModel(), axes: new JointAxes(), wall: new Plate(), virtual: new Plate(), trace: new Trace(),
      forces: new Forces(), ground: new Ground(), ghost: new Ghost() }; // prettier-ignore
    this.space.add(...Object.values(this.parts).map((part) => part.object));
    const sun = new DirectionalLight("#ffffff", 2.2);
    sun.position.set(2, -3, 5);
    this.space.add(sun, new AmbientLight("#ffffff", 1.4));
    new ResizeObserver(() => this.#resize()).observe(this.canvas.parentElement);
    const measured = new ResizeObserver(() => this.#measure());
    for (const id of OVER) measured.observe(at(id));
    store.on(["theme"], () => this.#colour());
    store.on(["run"], () => later("scene-run", () => this.#show(store.get("run"))));
    store.on(["before", "ghost"], () => later("ghost", () => this.#showGhost()));
    store.on(["time", "axes", "degrees", "guess"], () => this.draw());
    this.#colour();
  }

  /** Draw in the next frame. */
  draw() {
    show("scene", () => this.#draw());
  }

  /** The picture of the present moment as a canvas. */
  picture() {
    this.#draw();
    const copy = document.createElement("canvas");
    copy.width = this.canvas.width;
    copy.height = this.canvas.height;
    copy.getContext("2d").drawImage(this.canvas, 0, 0);
    return copy;
  }

  /** Keep all that is to be seen in the picture; it stays while something is dragged. isNew: another scenario is shown. */
  frame(isNew = false) {
    const stays = this.handles.some(({ held }) => held) || (!isNew && this.view.serves(this.points));
    this.view.frame(this.points, this.size, stays);
    this.draw();
  }

  #colour() {
    const theme = colours(this.store.get("theme"));
    this.theme = theme;
    this.space.background = new Color(theme.scene);
    for (const name of ["arm", "trace", "ground", "ghost"]) this.parts[name].colour(theme);
    this.parts.virtual.colour(theme.sky, theme.sky);
    this.draw();
  }

  #resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.view.resize(clientWidth, clientHeight);
    this.parts.trace.resize(clientWidth, clientHeight);
    this.labels.resize(clientWidth, clientHeight);
    this.draw();
  }

  #measure() {
    this.labels.measure();
    this.draw();
  }

  #show(run) {
    const size = run.arm.reach;
    const floor = floorOf(run, size);
    const opened = this.store.get("opened"); // the view stays while the same scenario is changed
    const isNew = opened !== this.opened || size !== this.size;
    Object.assign(this, { run, size, floor, opened, points: pointsOf(run, size, floor) });
    this.frame(isNew);
    this.parts.trace.show(run, size);
    this.parts.forces.show(run);
    this.#showVirtualWall(run.resolved.controller);
  }

  #showGhost() {
    const run = this.store.get("ghost") ? this.store.get("before") : null;
    this.parts.ghost.show(run);
    at("legend-before").hidden = !run;
    this.draw();
  }

  #showVirtualWall(controller) {
    const { virtual } = this.parts;
    virtual.object.visible = controller?.type === "virtual_wall";
    if (!virtual.object.visible) return;
    const frame = wallFrame({ normal: unit(controller.plane_normal) }, 0);
    virtual.place({ point: controller.plane_point, ...frame, sides: [0.6 * this.size, 0.6 * this.size] }, this.size);
  }

  #draw() {
    if (!this.run || !this.view.width) return;
    const time = this.store.get("time");
    const pose = poseAt(this.run, time);
    const { arm, axes, trace, forces, ground, ghost } = this.parts;
    arm.place(pose, this.size, this.floor);
    axes.object.visible = this.store.get("axes");
    axes.place(pose, this.size);
    trace.upTo(time, { ahead: this.store.get("guess")?.seen ?? true });
    ghost.place(time, pose, this.size, this.floor);
    forces.place(pose, this.size);
    ground.place(this.size, this.floor);
    this.#placeWall(pose);
    this.renderer.render(this.space, this.view.camera);
    this.#label(pose);
  }

  #placeWall({ wall: frame, contact }) {
    const { wall } = this.parts;
    wall.object.visible = Boolean(frame);
    if (!frame) return;
    const { theme } = this;
    const colour = contact ? theme.wall : theme.link; // grey, as in films, while nothing touches it
    wall.colour(colour, colour);
    wall.place({ ...frame, sides: plateSize(this.run.resolved.wall) }, this.size);
  }

  #label(pose) {
    const { arm, axes, forces, ground, ghost } = this.parts;
    const boxes = this.handles.map((handle) => handle.place(pose)).filter(Boolean);
    const pieces = [arm, axes, forces, ground, ghost].flatMap((part) => part.pieces);
    const wanted = captions(this.parts, pose, { theme: this.theme, degrees: this.store.get("degrees") });
    this.labels.show(wanted, { pieces, boxes, view: this.view });
    const place = pose.tip.map((value) => fixed(value, 3)).join(", ");
    this.canvas.setAttribute("aria-label", `The arm at t = ${shown(this.store.get("time"))} s: tip at ${place} m, ` +
      (pose.contact ? `in contact with the wall, ${forces.onWall.text}` : "not in contact")); // prettier-ignore
  }
}
