// The room in 3D: points, LiDARs, devices. Metres in the map frame, z up.
import {
  BufferAttribute, BufferGeometry, Color, GridHelper, Group, Line, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, PerspectiveCamera, Points, Quaternion, Scene, ShaderMaterial, SphereGeometry, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

export const COLOURS = { verified: 0x4cc38a, provisional: 0xf0b429, refused: 0xf2646a, ok: 0x5bb8e8, slow: 0xf0b429, bad: 0xf2646a };
const POINT_M = 0.045, PICK_PX = 28, TRAIL = 75;

const vertex = `
  uniform vec2 heights; uniform float size, pixels; varying float high;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    high = clamp((world.z - heights.x) / max(heights.y - heights.x, 0.1), 0.0, 1.0);
    vec4 seen = viewMatrix * world;
    gl_Position = projectionMatrix * seen;
    gl_PointSize = clamp(size * pixels * projectionMatrix[1][1] / max(-seen.z, 0.1), 1.5, 12.0);
  }`;
const fragment = `
  uniform vec3 colour; uniform float byHeight; varying float high;
  void main() {
    vec3 low = vec3(0.20, 0.29, 0.42), middle = vec3(0.33, 0.60, 0.66), top = vec3(0.93, 0.90, 0.72);
    vec3 ramp = high < 0.5 ? mix(low, middle, high * 2.0) : mix(middle, top, high * 2.0 - 1.0);
    gl_FragColor = vec4(mix(colour, ramp, byHeight), 1.0);
  }`;

function pointsOf(colour, byHeight, size_m) {
  const material = new ShaderMaterial({
    vertexShader: vertex, fragmentShader: fragment,
    uniforms: { heights: { value: [0, 3] }, size: { value: size_m }, pixels: { value: 500 },
      colour: { value: new Color(colour) }, byHeight: { value: byHeight } },
  });
  const points = new Points(new BufferGeometry(), material);
  points.frustumCulled = false;
  points.visible = false;
  return points;
}

/// A pyramid of lines from the sensor: tangents [left, right, top, bottom] at a depth; z ahead, y down.
function pyramid([left, right, top, bottom], depth, material) {
  const corners = [[left, top], [right, top], [right, bottom], [left, bottom]].map(([x, y]) => [x * depth, y * depth, depth]);
  const lines = [];
  corners.forEach((corner, i) => lines.push(0, 0, 0, ...corner, ...corner, ...corners[(i + 1) % 4]));
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(lines), 3));
  return new LineSegments(geometry, material);
}

function place(object, pose) {
  object.position.set(pose[0], pose[1], pose[2]);
  object.quaternion.copy(new Quaternion(pose[3], pose[4], pose[5], pose[6]));
}

function discard(object) {
  object.traverse((part) => {
    part.geometry?.dispose();
    part.material?.dispose();
  });
  object.removeFromParent();
}

class Device {
  constructor(scene) {
    this.material = new LineBasicMaterial();
    this.body = new Group();
    this.body.add(pyramid([-0.6, 0.6, -0.45, 0.45], 0.45, this.material));
    this.body.add(new Mesh(new SphereGeometry(0.09, 12, 8), new MeshBasicMaterial()));
    this.trail = new Line(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity: 0.7 }));
    this.trail.frustumCulled = false;
    this.doubt = new Mesh(new SphereGeometry(1, 20, 12),
      new MeshBasicMaterial({ transparent: true, opacity: 0.25, depthWrite: false }));
    this.doubt.matrixAutoUpdate = false;
    this.places = [];
    this.all = new Group().add(this.body, this.trail, this.doubt);
    scene.add(this.all);
  }

  show(told, chosen) {
    const colour = COLOURS[told.status] ?? COLOURS.refused;
    for (const part of [this.material, this.body.children[1].material, this.trail.material, this.doubt.material]) part.color.set(colour);
    this.all.visible = Boolean(told.pose);
    if (!told.pose) return;
    place(this.body, told.pose);
    this.body.scale.setScalar(chosen ? 1.5 : 1);
    this.doubt.visible = told.axes?.length === 9;
    if (this.doubt.visible) this.showDoubt(told.pose, told.axes);
    if (told.pose_verified) this.moveTo(told.pose);
  }

  /// Two standard deviations, and never too thin to be seen.
  showDoubt(pose, axes) {
    const column = (i) => {
      const axis = new Vector3(...axes.slice(3 * i, 3 * i + 3)).multiplyScalar(2);
      if (axis.length() < 0.02) axis.copy(new Vector3(i === 0, i === 1, i === 2)).multiplyScalar(0.02);
      return axis;
    };
    this.doubt.matrix = new Matrix4().makeBasis(column(0), column(1), column(2)).setPosition(pose[0], pose[1], pose[2]);
    this.doubt.matrixWorldNeedsUpdate = true;
  }

  moveTo([x, y, z]) {
    const n = this.places.length;
    if (n >= 3 && Math.hypot(x - this.places[n - 3], y - this.places[n - 2], z - this.places[n - 1]) < 0.02) return;
    this.places.push(x, y, z);
    this.drawTrail();
  }

  drawTrail() {
    this.places.splice(0, Math.max(0, this.places.length - 3 * TRAIL));
    this.trail.geometry.dispose();
    this.trail.geometry = new BufferGeometry();
    this.trail.geometry.setAttribute('position', new BufferAttribute(new Float32Array(this.places), 3));
  }
}

export class Room {
  /// `onPick(id)`: a device was clicked at.
  constructor(canvas, labels, onPick) {
    this.canvas = canvas;
    this.labels = labels;
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setClearColor(0x10151b);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(50, 1, 0.1, 500);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => { this.dirty = true; });
    this.clouds = { room: pointsOf(0xffffff, 1, POINT_M), moving: pointsOf(0xff8a3d, 0, 0.13), scan: pointsOf(0xf08fe0, 0, 0.07) };
    this.grid = new GridHelper(60, 60, 0x2a3440, 0x1c242d);
    this.grid.rotateX(Math.PI / 2);
    this.scene.add(this.grid, ...Object.values(this.clouds));
    this.lidars = [];
    this.devices = new Map();
    this.tags = new Map();
    this.watchPicks(onPick);
    this.camera.position.set(8, -10, 9);
    this.controls.update();
    const draw = () => {
      requestAnimationFrame(draw);
      this.draw();
    };
    draw();
  }

  /// But for the camera.
  clear() {
    for (const cloud of Object.values(this.clouds)) cloud.visible = false;
    this.showSite([]);
    this.showDevices([], null);
  }

  /// Points as `pointsOf` of messages.js has them.
  showPoints(told) {
    const cloud = this.clouds[told.kind];
    cloud.geometry.dispose();
    cloud.geometry = new BufferGeometry();
    cloud.geometry.setAttribute('position', new BufferAttribute(told.steps, 3));
    cloud.position.set(...told.low);
    cloud.scale.set(...told.step);
    cloud.visible = told.count > 0;
    this.dirty = true;
    if (told.kind !== 'room' || told.count === 0) return;
    this.low = new Vector3(...told.low);
    this.high = this.low.clone().add(new Vector3(...told.step).multiplyScalar(65535));
    cloud.material.uniforms.heights.value = [this.low.z, Math.min(this.high.z, this.low.z + 3)];
    this.grid.position.z = this.low.z - 0.02;
    if (!this.framed) this.look(false);
    this.framed = true;
  }

  hideScan() {
    this.clouds.scan.visible = false;
    this.dirty = true;
  }

  /// The whole room, from above or askance.
  look(fromAbove) {
    if (!this.low) return;
    const middle = this.low.clone().add(this.high).multiplyScalar(0.5);
    const size = this.high.clone().sub(this.low);
    const wide = Math.tan(this.camera.fov * Math.PI / 360) * Math.min(this.camera.aspect, 1);
    const away = 0.46 * Math.hypot(size.x, size.y, size.z) / wide;
    const direction = fromAbove ? new Vector3(0, -0.01, 1) : new Vector3(0.45, -0.75, 0.75);
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(direction.normalize(), away);
    this.controls.update();
    this.dirty = true;
  }

  showSite(lidars) {
    this.lidars.forEach((held) => discard(held.group));
    this.lidars = lidars.map((told) => {
      const group = new Group();
      const near = new LineBasicMaterial(), far = new LineBasicMaterial({ transparent: true, opacity: 0.22 });
      group.add(pyramid(told.view, 0.4, near), pyramid(told.view, Math.min(told.range, 4), far));
      place(group, told.pose);
      this.scene.add(group);
      return { id: told.id, group, materials: [near, far] };
    });
    this.dirty = true;
  }

  showHealth(states) {
    this.lidars.forEach((held, i) => held.materials.forEach((material) => material.color.set(COLOURS[states[i]] ?? COLOURS.bad)));
    this.dirty = true;
  }

  showDevices(told, chosen) {
    const here = new Set(told.map((device) => device.id));
    for (const [id, held] of this.devices) {
      if (here.has(id)) continue;
      discard(held.all);
      this.devices.delete(id);
    }
    for (const device of told) {
      if (!this.devices.has(device.id)) this.devices.set(device.id, new Device(this.scene));
      this.devices.get(device.id).show(device, device.id === chosen);
    }
    this.dirty = true;
  }

  showTrails(of) {
    for (const [id, centimetres] of Object.entries(of)) {
      const held = this.devices.get(id);
      if (!held || !Array.isArray(centimetres)) continue;
      held.places = centimetres.map((value) => value / 100);
      held.drawTrail();
    }
    this.dirty = true;
  }

  watchPicks(onPick) {
    let down = null;
    this.canvas.addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
    this.canvas.addEventListener('pointerup', (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 5) return; // it was a turn
      const box = this.canvas.getBoundingClientRect();
      let best = null, nearest = PICK_PX;
      for (const [id, held] of this.devices) {
        const at = held.all.visible && this.pixelOf(held.body.position);
        const away = at ? Math.hypot(at[0] - event.clientX + box.left, at[1] - event.clientY + box.top) : Infinity;
        if (away < nearest) [best, nearest] = [id, away];
      }
      if (best) onPick(best);
    });
  }

  /// Null behind the camera.
  pixelOf(place_map) {
    const p = place_map.clone().project(this.camera);
    if (p.z > 1) return null;
    return [(p.x + 1) / 2 * this.canvas.clientWidth, (1 - p.y) / 2 * this.canvas.clientHeight];
  }

  fitCanvas() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (this.width === width && this.height === height) return;
    [this.width, this.height] = [width, height];
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
    const pixels = this.renderer.getPixelRatio() * height / 2;
    for (const cloud of Object.values(this.clouds)) cloud.material.uniforms.pixels.value = pixels;
    this.dirty = true;
  }

  tag(key, text, kind, place_map) {
    let tag = this.tags.get(key);
    if (!tag) {
      tag = document.createElement('span');
      tag.className = kind;
      tag.textContent = text;
      this.labels.append(tag);
      this.tags.set(key, tag);
    }
    const at = this.pixelOf(place_map);
    tag.hidden = !at;
    if (at) tag.style.transform = `translate(${at[0] + 10}px, ${at[1] - 10}px)`;
  }

  drawTags() {
    const wanted = new Set();
    const mark = (key, ...rest) => {
      wanted.add(key);
      this.tag(key, ...rest);
    };
    for (const held of this.lidars) mark(`lidar ${held.id}`, held.id, 'lidar', held.group.position);
    for (const [id, held] of this.devices) if (held.all.visible) mark(`device ${id}`, id, 'device', held.body.position);
    for (const [key, tag] of this.tags) {
      if (wanted.has(key)) continue;
      tag.remove();
      this.tags.delete(key);
    }
  }

  draw() {
    this.fitCanvas();
    if (!this.dirty) return;
    this.dirty = false;
    this.renderer.render(this.scene, this.camera);
    this.drawTags();
    this.canvas.dataset.points = this.renderer.info.render.points;
  }
}
