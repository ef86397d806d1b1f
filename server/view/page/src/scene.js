// The room in 3D: points, LiDARs, devices. Metres in the map frame, z up.
import { GridHelper, Group, LineBasicMaterial, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Device } from './device.js';
import { Labels } from './labels.js';
import { COLOURS, discard, place, pyramid } from './pieces.js';
import { emptyCloud, fillCloud } from './points.js';

const PICK_PX = 28;

export class Room {
  /// `onPick(id)`: a device was clicked at.
  constructor(canvas, labels, onPick) {
    this.canvas = canvas;
    this.labels = new Labels(labels, (place_map) => this.pixelOf(place_map));
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setClearColor(0x10151b);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(50, 1, 0.1, 500);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => { this.dirty = true; });
    this.clouds = {
      room: emptyCloud(0xffffff, 1, 0.045), moving: emptyCloud(0xff8a3d, 0, 0.13), scan: emptyCloud(0xf08fe0, 0, 0.07),
    };
    this.grid = new GridHelper(60, 60, 0x2a3440, 0x1c242d);
    this.grid.rotateX(Math.PI / 2);
    this.scene.add(this.grid, ...Object.values(this.clouds));
    this.lidars = [];
    this.devices = new Map();
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
    fillCloud(cloud, told);
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

  draw() {
    this.fitCanvas();
    if (!this.dirty) return;
    this.dirty = false;
    this.renderer.render(this.scene, this.camera);
    this.labels.show([
      ...this.lidars.map((held) => ({ text: held.id, kind: 'lidar', place: held.group.position })),
      ...[...this.devices].filter(([, held]) => held.all.visible)
        .map(([id, held]) => ({ text: id, kind: 'device', place: held.body.position })),
    ]);
    this.canvas.dataset.points = this.renderer.info.render.points;
  }
}
