// What stands in the room besides points.
import { BufferAttribute, BufferGeometry, LineSegments, Quaternion } from 'three';

export const COLOURS = {
  verified: 0x4cc38a, provisional: 0xf0b429, refused: 0xf2646a, ok: 0x5bb8e8, slow: 0xf0b429, bad: 0xf2646a,
};

/// A pyramid of lines from the sensor: tangents [left, right, top, bottom] at a depth; z ahead, y down.
export function pyramid([left, right, top, bottom], depth, material) {
  const corners = [[left, top], [right, top], [right, bottom], [left, bottom]].map(([x, y]) => [x * depth, y * depth, depth]);
  const lines = [];
  corners.forEach((corner, i) => lines.push(0, 0, 0, ...corner, ...corner, ...corners[(i + 1) % 4]));
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(lines), 3));
  return new LineSegments(geometry, material);
}

export function place(object, pose) {
  object.position.set(pose[0], pose[1], pose[2]);
  object.quaternion.copy(new Quaternion(pose[3], pose[4], pose[5], pose[6]));
}

export function discard(object) {
  object.traverse((part) => {
    part.geometry?.dispose();
    part.material?.dispose();
  });
  object.removeFromParent();
}
