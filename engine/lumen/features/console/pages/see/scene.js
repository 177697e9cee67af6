// @ts-check
// Draws links with their shapes on a floor. three.js does the drawing; a frame is drawn when something has moved.
/** @import { Form, Pose, Shape } from "../types" */
import * as THREE from "../vendor/three.js";

const REACH = 1.1; // [m]
/** @type {[x: number, y: number, z: number]} */
const EYE = [1.02, 0.68, 0.62]; // [m]
/** @type {[x: number, y: number, z: number]} */
const LOOK = [0, 0, 0.26]; // [m]

/** @type {Record<string, (size: [number, number, number]) => THREE.BufferGeometry>} */
const MAKERS = {
  box: ([x, y, z]) => new THREE.BoxGeometry(2 * x, 2 * y, 2 * z),
  ellipsoid: ([x, y, z]) => new THREE.SphereGeometry(1, 24, 16).scale(x, y, z),
  sphere: ([r]) => new THREE.SphereGeometry(r, 24, 16),
  cylinder: ([r, half]) => new THREE.CylinderGeometry(r, r, 2 * half, 24).rotateX(Math.PI / 2),
  capsule: ([r, half]) => new THREE.CapsuleGeometry(r, 2 * half, 8, 24).rotateX(Math.PI / 2),
};

/**
 * The geometry of a shape: half sizes and z along a capsule, as MuJoCo has them.
 * @param {Shape} shape
 */
export function geometry({ kind, size, vertices, faces }) {
  if (kind !== "mesh") return (MAKERS[kind] ?? MAKERS.ellipsoid)(/** @type {[number, number, number]} */ (size));
  const made = new THREE.BufferGeometry();
  made.setAttribute("position", new THREE.BufferAttribute(new Float32Array(vertices.flat()), 3));
  made.setIndex(faces.flat());
  made.computeVertexNormals();
  return made;
}

/**
 * @param {THREE.Object3D} object
 * @param {number[]} position
 * @param {number[]} rotation
 */
function place(object, [x, y, z], [w, i, j, k]) {
  object.position.set(x, y, z);
  object.quaternion.set(i, j, k, w);
}

export class Scene {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Form} form
   */
  constructor(canvas, { links, stage }) {
    this.canvas = canvas;
    /** @type {Map<string, THREE.Group>} */
    this.links = new Map();
    this.scene = new THREE.Scene();
    this.asked = 0; // the next frame, if one is asked for
    this.robot = new THREE.Group();
    this.robot.visible = false; // until a pose puts the links where they belong: before that they are a heap
    this.scene.add(this.robot);
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.camera = new THREE.PerspectiveCamera(38, 4 / 3, 0.05, 30);
    this.camera.up.set(0, 0, 1);
    this.turn = Math.atan2(EYE[1], EYE[0]);
    this.far = Math.hypot(EYE[0], EYE[1]);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x667788, 1.6));
    const sun = new THREE.DirectionalLight(0xffffff, 2);
    sun.position.set(2, 1, 4);
    this.scene.add(sun, this.floor(stage));
    for (const link of links) this.add(link);
    this.moves = new AbortController();
    this.listen();
    this.draw();
  }

  /** @param {Form["stage"]} stage */
  floor(stage) {
    const [[left, right], [back, front]] = stage
      ? [stage.x, stage.y]
      : [
          [-REACH, REACH],
          [-REACH, REACH],
        ];
    const ground = new THREE.Mesh(
      new THREE.BoxGeometry(right - left, front - back, 0.02),
      new THREE.MeshLambertMaterial({ color: 0x9fb4c4 }),
    );
    ground.position.set((left + right) / 2, (front + back) / 2, -0.012);
    const lines = new THREE.GridHelper(2 * REACH, 11, 0x6b7f8f, 0x8ea1b0).rotateX(Math.PI / 2);
    return new THREE.Group().add(ground, lines);
  }

  /** @param {Form["links"][number]} link */
  add({ name, shapes }) {
    const link = new THREE.Group();
    for (const shape of shapes) {
      const [r, g, b, a] = shape.colour;
      const mesh = new THREE.Mesh(
        geometry(shape),
        new THREE.MeshStandardMaterial({
          color: new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace),
          roughness: 0.6,
          transparent: a < 1,
          opacity: a,
        }),
      );
      place(mesh, shape.position, shape.rotation);
      link.add(mesh);
    }
    this.links.set(name, link);
    this.robot.add(link);
  }

  /**
   * Put the links where a pose says; those that it does not name stay.
   * @param {Pose} links
   */
  pose(links) {
    for (const [name, at] of Object.entries(links)) {
      const link = this.links.get(name);
      if (link) place(link, at.slice(0, 3), at.slice(3));
    }
    this.robot.visible = true;
    this.draw();
  }

  listen() {
    // dragging turns the view; so do the arrow keys
    /**
     * @template {"pointermove" | "keydown"} Kind
     * @param {Kind} kind
     * @param {(event: HTMLElementEventMap[Kind]) => void} handler
     */
    const on = (kind, handler) => this.canvas.addEventListener(kind, handler, { signal: this.moves.signal });
    this.canvas.tabIndex = 0;
    on("pointermove", (event) => {
      if (event.buttons) {
        this.turn -= event.movementX / 150;
        this.draw();
      }
    });
    on("keydown", (event) => {
      const by = event.key === "ArrowLeft" ? -0.15 : event.key === "ArrowRight" ? 0.15 : 0;
      if (by) {
        event.preventDefault();
        this.turn += by;
        this.draw();
      }
    });
    addEventListener("resize", () => this.draw(), { signal: this.moves.signal });
  }

  draw() {
    if (this.asked) return;
    this.asked = requestAnimationFrame(() => {
      this.asked = 0;
      const { clientWidth: wide, clientHeight: high } = this.canvas;
      this.renderer.setSize(wide, high, false);
      this.camera.aspect = wide / Math.max(1, high);
      this.camera.updateProjectionMatrix();
      this.camera.position.set(Math.cos(this.turn) * this.far, Math.sin(this.turn) * this.far, EYE[2]);
      this.camera.lookAt(...LOOK);
      this.renderer.render(this.scene, this.camera);
    });
  }

  close() {
    this.moves.abort();
    cancelAnimationFrame(this.asked);
    this.renderer.dispose();
  }
}
