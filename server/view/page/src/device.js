// A device: where it is and looks, how sure that is, and its trail.
import {
  BufferAttribute, BufferGeometry, Group, Line, LineBasicMaterial, Matrix4, Mesh, MeshBasicMaterial, SphereGeometry, Vector3,
} from 'three';
import { COLOURS, place, pyramid } from './pieces.js';

const TRAIL = 75; // as the server keeps it

export class Device {
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
