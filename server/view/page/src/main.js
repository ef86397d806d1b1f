import { drawLatencies, drawOutcomes } from './charts.js';
import { follow } from './live.js';
import { pointsOf } from './messages.js';
import { healthOf, showChosen, showDevices, showLidars, showLoad, showLog, showSite } from './panel.js';
import { Room } from './scene.js';

const byId = (id) => document.getElementById(id);
let site = [], devices = [], chosen = null, scanKey = null;

const room = new Room(byId('view'), byId('labels'), (id) => choose(id));
byId('top').addEventListener('click', () => room.look(true));
byId('fit').addEventListener('click', () => room.look(false));
byId('unchoose').addEventListener('click', () => choose(null));

function choose(id) {
  chosen = id === chosen ? null : id;
  redraw();
}

function redraw() {
  const device = devices.find((held) => held.id === chosen);
  room.showDevices(devices, chosen);
  showDevices(devices, chosen, choose);
  showChosen(device);
  showScan(device);
}

/// The cloud of the chosen device, where it was not located: fetched once an answer.
async function showScan(device) {
  const key = device?.scan === null || !device ? null : `${device.id} ${device.scan}`;
  if (key === scanKey) return;
  scanKey = key;
  byId('chosen-scan').textContent = '';
  if (!key) return room.hideScan();
  let told = null;
  try {
    const answer = await fetch(`scan?device=${encodeURIComponent(device.id)}`);
    if (answer.ok) told = pointsOf(await answer.arrayBuffer());
  } catch { /* the live connection tells that the server is gone */ }
  if (key !== scanKey) return;
  if (!told) room.hideScan();
  else room.showPoints(told);
  byId('chosen-scan').textContent = told ? 'Its cloud is drawn where it was guessed to be.'
    : 'Its cloud cannot be drawn: nobody knows where the device is.';
}

const takes = {
  site(told) {
    site = told.lidars;
    showSite(told);
    room.showSite(site);
  },
  now(told) {
    devices = told.devices;
    showLoad(told);
    showLidars(site, told.lidars);
    room.showHealth(told.lidars.map((lidar) => healthOf(lidar.state)));
    redraw();
  },
  trails(told) { room.showTrails(told.of); },
  charts(told) {
    drawOutcomes(byId('outcomes'), told);
    drawLatencies(byId('latencies'), told);
  },
  log(told) { showLog(told.lines); },
};

follow({
  open() {
    byId('banner').textContent = '';
    room.clear();
    scanKey = null;
  },
  message(told) {
    if (told.kind) {
      room.showPoints(told);
      byId(`${told.kind}-points`).textContent = told.count;
    } else {
      takes[told.part]?.(told);
    }
  },
  lost(text) { byId('banner').textContent = text; },
});
