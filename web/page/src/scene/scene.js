/** The arm, the wall and the forces at the present time of the run, in three dimensions. */
import { AmbientLight, Color, DirectionalLight, Scene as Space, Vector3, WebGLRenderer } from "three";
import { JOINTS, colours } from "../app/colours.js";
import { at } from "../app/dom.js";
import { later, show } from "../app/frames.js";
import { shown } from "../app/numbers.js";
import { ArmModel } from "./arm.js";
import { Forces } from "./forces.js";
import { Ground } from "./ground.js";
import { JointAxes } from "./joint_axes.js";
import { Labels } from "./labels.js";
import { Plate } from "./plate.js";
import { plateSize, poseAt, unit, wallFrame } from "./pose.js";
import { Trace } from "./trace.js";
import { View } from "./view.js";

export class Scene {
  /** Throws an Error where the browser has no WebGL. */
  constructor(store) {
    this.store = store;
    this.canvas = at("scene-canvas");
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, preserveDrawingBuffer: false });
    this.renderer.debug.checkShaderErrors = false; // asking for them waits for the graphics driver
    this.space = new Space();
    this.view = new View(this.canvas, () => this.draw());
    this.labels = new Labels(at("scene-labels"));
    this.parts = { arm: new ArmModel(), axes: new JointAxes(), wall: new Plate(), virtual: new Plate(), trace: new Trace(),
      forces: new Forces(), ground: new Ground() }; // prettier-ignore
    this.space.add(...Object.values(this.parts).map((part) => part.object));
    const sun = new DirectionalLight("#ffffff", 2.2);
    sun.position.set(2, -3, 5);
    this.space.add(sun, new AmbientLight("#ffffff", 1.4));
    new ResizeObserver(() => this.#resize()).observe(this.canvas.parentElement);
    store.on(["theme"], () => this.#colour());
    store.on(["run"], () => later("scene-run", () => this.#show(store.get("run"))));
    store.on(["time", "axes", "guess"], () => this.draw());
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

  #colour() {
    const theme = colours(this.store.get("theme"));
    this.theme = theme;
    this.space.background = new Color(theme.scene);
    for (const name of ["arm", "trace", "ground"]) this.parts[name].colour(theme);
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

  #show(run) {
    const size = run.arm.reach;
    const floor = floorOf(run, size);
    const opened = this.store.get("opened"); // the view stays while the same scenario is changed
    if (opened !== this.opened || size !== this.size) this.view.frame(pointsOf(run, size, floor), size);
    Object.assign(this, { run, size, floor, opened });
    this.parts.trace.show(run, size);
    this.parts.forces.show(run);
    this.#showVirtualWall(run.resolved.controller);
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
    if (!this.run) return;
    const time = this.store.get("time");
    const pose = poseAt(this.run, time);
    const { arm, axes, trace, forces, ground } = this.parts;
    arm.place(pose, this.size, this.floor);
    axes.object.visible = this.store.get("axes");
    axes.place(pose, this.size);
    trace.upTo(time, { ahead: this.store.get("guess")?.seen ?? true });
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
    const { face_offset: offset } = this.run.resolved.wall;
    const point = frame.point.map((value, i) => value + offset * frame.normal[i]);
    wall.place({ ...frame, point, sides: plateSize(this.run.resolved.wall) }, this.size);
  }

  #label(pose) {
    const { camera } = this.view;
    const put = (name, text, point, look) => this.labels.put(name, text, point, camera, look);
    const visible = this.store.get("axes");
    this.parts.axes.ends().forEach((end, i) => {
      put(`q${i + 1}`, visible ? `q${"₁₂₃"[i]}` : "", end, { colour: JOINTS[i] });
    });
    this.parts.ground.axes.forEach((axis, i) => put("xyz"[i], "xyz"[i], axis.tip, { colour: this.theme.faint }));
    const { onWall, onTip } = this.parts.forces;
    const from = new Vector3(...pose.tip);
    put("on wall", onWall.text && `on the wall ${onWall.text}`, onWall.tip, { from });
    put("on tip", onTip.text && `on the tip ${onTip.text}`, onTip.tip, { from });
    const place = pose.tip.map((value) => shown(value, 3)).join(", ");
    this.canvas.setAttribute("aria-label", `The arm at t = ${shown(this.store.get("time"))} s: tip at ${place} m, ` +
      (pose.contact ? `in contact with the wall, ${onWall.text}` : "not in contact")); // prettier-ignore
  }
}

/** What is to be seen: the base with its axes, and the arm at some times of the run. */
function pointsOf(run, size, floor) {
  const { t } = run.columns;
  const points = [[0, 0, floor], [0, -0.4 * size, floor]];
  for (let k = 0; k <= 20; k += 1) {
    const pose = poseAt(run, t[0] + (k / 20) * (t[t.length - 1] - t[0]));
    points.push(...pose.points.slice(1));
  }
  return points;
}

/** Height of the floor: that of the base, or below all that the tip does, in steps of half the reach. */
function floorOf({ columns, arm }, size) {
  const height = arm.points[5];
  let lowest = Math.min(0, height);
  for (const z of columns.tip_z) lowest = Math.min(lowest, z);
  if (height > 0.1 * size && lowest >= 0) return 0;
  return -Math.max(1, Math.ceil((-lowest / size) * 2 - 1e-6)) * 0.5 * size;
}
