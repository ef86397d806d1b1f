// What the server sends: text_messages.hpp and points_message.hpp say how.

const KINDS = { 1: 'room', 2: 'moving', 3: 'scan' };
const HEAD = 32;

/// {kind, count, low: [m], step: [m], steps: Uint16Array}, or null where it is something else.
export function pointsOf(buffer) {
  if (buffer.byteLength < HEAD) return null;
  const head = new DataView(buffer);
  const kind = KINDS[head.getUint8(0)];
  const count = head.getUint32(4, true);
  if (!kind || head.getUint8(1) !== 1 || buffer.byteLength !== HEAD + 6 * count) return null;
  const three = (at) => [0, 4, 8].map((more) => head.getFloat32(at + more, true));
  return { kind, count, low: three(8), step: three(20), steps: new Uint16Array(buffer, HEAD, 3 * count) };
}

/// The message of a WebSocket event, with `part` or `kind`; null where it cannot be read.
export function messageOf(data) {
  if (data instanceof ArrayBuffer) return pointsOf(data);
  try {
    return JSON.parse(data);
  } catch {
    return null;
  }
}
