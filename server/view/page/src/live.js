// The live messages, for as long as the page is open: where the server goes away it is looked for again.
import { messageOf } from './messages.js';

const FIRST_MS = 500, LONGEST_MS = 5000, SILENT_MS = 10000;

/// Calls `on.open()` for each new connection, `on.message(message)`, and `on.lost(text)`.
export function follow(on) {
  let pause_ms = FIRST_MS;
  const connect = () => {
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(`${scheme}//${location.host}/live`);
    socket.binaryType = 'arraybuffer';
    let heard = false;
    let silence = 0;
    const listen = () => {
      clearTimeout(silence);
      silence = setTimeout(() => socket.close(), SILENT_MS); // five pictures a second are due
    };
    socket.onopen = () => {
      on.open();
      listen();
    };
    socket.onmessage = (event) => {
      heard = true;
      pause_ms = FIRST_MS;
      listen();
      const message = messageOf(event.data);
      if (message) on.message(message);
    };
    socket.onclose = () => {
      clearTimeout(silence);
      on.lost(heard ? 'The server is gone; looking for it again'
        : 'The server does not answer, has as many viewers as it takes, or asks for a new token (see its log); trying again');
      setTimeout(connect, pause_ms);
      pause_ms = Math.min(2 * pause_ms, LONGEST_MS);
    };
  };
  connect();
}
