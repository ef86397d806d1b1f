// All beside the room: lists, figures, the log. Texts from outside are set as text, never as HTML.
const byId = (id) => document.getElementById(id);

const ADVICE = {
  wait: 'Few answers so far: more of the same will do.',
  turn_around: 'The ceiling sees little of what the device sees: let it look elsewhere.',
  move_on: 'What can be seen from there fits no place distinctly: let the device move on.',
  more_coverage: 'The ceiling hardly sees this place: a LiDAR is missing here.',
  twin: 'Another place of the room looks alike.',
  clear_view: 'Lines of sight are contradicted: people close by, or a calibration that is off.',
};

export function element(name, className, text) {
  const made = document.createElement(name);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
}

const number = (value, digits, unit) => (value === null || value === undefined ? '-' : `${value.toFixed(digits)}${unit}`);
export const healthOf = (state) => (state === 'ok' || state === 'slow' ? state : 'bad');

function duration(s) {
  const [days, hours, minutes] = [Math.floor(s / 86400), Math.floor(s / 3600) % 24, Math.floor(s / 60) % 60];
  if (days) return `${days} d ${hours} h`;
  return hours ? `${hours} h ${minutes} min` : `${minutes} min ${Math.floor(s % 60)} s`;
}

export function showSite(told) {
  byId('server').textContent = told.server;
  document.title = `${told.server}: LiLoc`;
  byId('server').title = `version ${told.version}`;
}

export function showLoad(told) {
  byId('uptime').textContent = duration(told.uptime_s);
  byId('load').textContent = `${told.clients} connected, ${told.queued} waiting; ${told.answered} answered, `
    + `${told.verified} verified, ${told.refused} refused; newest frame ${number(told.gpc_age_s === null ? null : 1000 * told.gpc_age_s, 0, ' ms')} old`;
}

export function showLidars(site, lidars) {
  byId('lidars').replaceChildren(...lidars.map((lidar, i) => {
    const item = element('li');
    item.append(element('span', `dot ${healthOf(lidar.state)}`), element('span', 'name', site[i]?.id ?? `${i}`),
      element('span', 'figure', `${lidar.state}  ${number(lidar.hz, 1, ' Hz')}  ${number(100 * lidar.returns, 0, ' %')}`));
    if (lidar.error && lidar.state !== 'ok') item.append(element('span', 'error', lidar.error));
    return item;
  }));
}

/// The list is kept as it is, so that a button does not go away under a finger.
export function showDevices(devices, chosen, choose) {
  const list = byId('devices');
  const ids = devices.map((device) => device.id).join(' ');
  if (list.dataset.ids !== ids) {
    list.dataset.ids = ids;
    list.replaceChildren(...devices.map(({ id }) => {
      const button = element('button');
      button.type = 'button';
      button.dataset.id = id;
      button.addEventListener('click', () => choose(id));
      button.append(element('span', 'dot'), element('span', 'name', id), element('span', 'figure'));
      const item = element('li');
      item.append(button);
      return item;
    }));
    if (devices.length === 0) list.append(element('li', 'none', 'None has asked within a minute.'));
  }
  devices.forEach((device, i) => {
    const button = list.children[i].firstChild;
    button.setAttribute('aria-pressed', device.id === chosen);
    button.children[0].className = `dot ${device.status}`;
    button.children[2].textContent = device.age_s > 5 ? `silent for ${device.age_s.toFixed(0)} s`
      : `${device.status}  ${number(device.latency_ms, 0, ' ms')}`;
  });
}

/// The longest axis is what counts.
function deviation(axes) {
  if (axes?.length !== 9) return null;
  return 100 * Math.max(...[0, 3, 6].map((i) => Math.hypot(axes[i], axes[i + 1], axes[i + 2])));
}

export function showChosen(device) {
  byId('chosen').hidden = !device;
  if (!device) return;
  byId('chosen-id').textContent = device.id;
  byId('chosen-why').textContent = `${device.status}: ${device.reason.replaceAll('_', ' ')}${device.text ? `. ${device.text}` : ''}`;
  byId('chosen-advice').textContent = ADVICE[device.advice] ?? '';
  const figures = [
    ['confidence', device.confidence === null ? '-' : `${(100 * device.confidence).toFixed(2)} %`],
    ['position', device.pose ? device.pose.slice(0, 3).map((v) => v.toFixed(2)).join(', ') + ' m' : 'not known'],
    ['deviation', number(deviation(device.axes), 1, ' cm')],
    ['agreement', number(100 * device.overlap, 0, ' %')],
    ['latency', number(device.latency_ms, 1, ' ms')],
    ['answers', `${device.answers}, last ${device.age_s.toFixed(1)} s ago`],
  ];
  byId('chosen-figures').replaceChildren(...figures.flatMap(([name, value]) => [element('dt', '', name), element('dd', '', value)]));
}

export function showLog(lines) {
  const list = byId('log');
  const atEnd = list.scrollTop + list.clientHeight > list.scrollHeight - 30;
  list.replaceChildren(...lines.map(([ms, level, text]) => {
    const item = element('li', level);
    item.append(element('time', '', new Date(ms).toLocaleTimeString([], { hour12: false })), text);
    return item;
  }));
  if (atEnd) list.scrollTop = list.scrollHeight;
}
