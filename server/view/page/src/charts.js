// Two small charts of the last ten minutes.
const style = getComputedStyle(document.documentElement);
const colour = (name) => style.getPropertyValue(`--${name}`).trim();
const P95 = '#8a78d8';

function blank(canvas) {
  const ratio = Math.min(devicePixelRatio, 2);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const pen = canvas.getContext('2d');
  pen.scale(ratio, ratio);
  pen.font = '11px system-ui, sans-serif';
  return { pen, width, height };
}

function rule(pen, width, y, text) {
  pen.fillStyle = colour('line');
  pen.fillRect(0, Math.round(y), width, 1);
  pen.fillStyle = colour('dim');
  pen.fillText(text, 2, Math.round(y) - 3);
}

export function drawOutcomes(canvas, told) {
  const { pen, width, height } = blank(canvas);
  const sums = told.verified.map((count, i) => count + told.provisional[i] + told.refused[i]);
  const most = Math.max(1, ...sums), step = width / sums.length, scale = (height - 16) / most;
  sums.forEach((_, i) => {
    let y = height;
    for (const outcome of ['verified', 'provisional', 'refused']) {
      const tall = told[outcome][i] * scale;
      pen.fillStyle = colour(outcome);
      pen.fillRect(i * step, y -= tall, Math.max(step - 0.5, 1), tall);
    }
  });
  rule(pen, width, 14, `${(most / told.column_s).toFixed(1)} a second`);
}

export function drawLatencies(canvas, told) {
  const { pen, width, height } = blank(canvas);
  const step = width / told.median_ms.length;
  const yOf = (ms) => height - 2 - (height - 4) * Math.min(1, Math.max(0, Math.log10(ms) / 4)); // 1 ms to 10 s
  for (const [ms, text] of [[10, '10 ms'], [100, '100 ms'], [1000, '1 s']]) rule(pen, width, yOf(ms), text);
  for (const [row, stroke] of [['p95_ms', P95], ['median_ms', colour('accent')]]) {
    pen.fillStyle = stroke;
    told[row].forEach((ms, i) => { if (ms !== null) pen.fillRect(i * step, yOf(ms) - 1, Math.max(step, 2), 2.5); });
  }
}
