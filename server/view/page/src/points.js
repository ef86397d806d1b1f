// Points as the server sends them: 16-bit numbers, placed by the object's position and scale.
import { BufferAttribute, BufferGeometry, Color, Points, ShaderMaterial } from 'three';

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

/// Without points yet. By height: dark below, bright above; else in one colour.
export function emptyCloud(colour, byHeight, size_m) {
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

/// `told` as `pointsOf` of messages.js has it.
export function fillCloud(cloud, told) {
  cloud.geometry.dispose();
  cloud.geometry = new BufferGeometry();
  cloud.geometry.setAttribute('position', new BufferAttribute(told.steps, 3));
  cloud.position.set(...told.low);
  cloud.scale.set(...told.step);
  cloud.visible = told.count > 0;
}
