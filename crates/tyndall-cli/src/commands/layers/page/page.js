'use strict';

const content = JSON.parse(document.getElementById('content').textContent);
const pixels = content.width * content.height;
const element = id => document.getElementById(id);

/* From what is in the page to numbers. */

// The value of every 16-bit float.
const floatOfHalf = Float32Array.from({ length: 1 << 16 }, (_, bits) => {
  const [sign, exponent, fraction] = [bits & 0x8000 ? -1 : 1, (bits >> 10) & 31, bits & 1023];
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return exponent === 0 ? sign * fraction * 2 ** -24 : sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
});

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const half = planes.length / 2;
  return Float32Array.from({ length: half }, (_, i) => content.unit * floatOfHalf[(planes[i] << 8) | planes[half + i]]);
}

// Means over squares of pixels.
function thumbnail(values) {
  const edge = Math.max(1, Math.floor(content.width / 84));
  const [width, height] = [Math.floor(content.width / edge), Math.max(1, Math.floor(content.height / edge))];
  const small = new Float32Array(3 * width * height);
  for (let y = 0; y < Math.min(height * edge, content.height); y++) {
    for (let x = 0; x < width * edge; x++) {
      for (let c = 0; c < 3; c++) {
        const at = 3 * (Math.floor(y / edge) * width + Math.floor(x / edge)) + c;
        small[at] += values[3 * (y * content.width + x) + c] / (edge * edge);
      }
    }
  }
  return { width, height, values: small };
}

/* From light to the screen. */

// sRGB (IEC 61966-2-1) of linear values between 0 and 1, in bytes.
const STEPS = 1 << 16;
const encoded = Uint8ClampedArray.from({ length: STEPS + 1 }, (_, i) => {
  const v = i / STEPS;
  return Math.floor(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055) + 0.5);
});

// What is not a number is magenta, as in the program's own files.
function show(canvas, width, height, values, gain) {
  const byte = v => encoded[Math.round(STEPS * Math.min(Math.max(gain * v, 0), 1))];
  const image = new ImageData(width, height);
  for (let i = 0, at = 0; i < values.length; i += 3, at += 4) {
    const known = !(isNaN(values[i]) || isNaN(values[i + 1]) || isNaN(values[i + 2]));
    image.data[at] = known ? byte(values[i]) : 255;
    image.data[at + 1] = known ? byte(values[i + 1]) : 0;
    image.data[at + 2] = known ? byte(values[i + 2]) : 255;
    image.data[at + 3] = 255;
  }
  canvas.width = width;
  canvas.height = height;
  canvas.getContext('2d').putImageData(image, 0, 0);
}

/* The state, and the picture of it. */

const layers = content.groups.flatMap(group => group.layers);
for (const layer of layers) Object.assign(layer, { weight: 1, solo: false, mute: false });
let group = content.groups[0];

function weightOf(layer) {
  const alone = group.layers.some(other => other.solo);
  return (alone ? layer.solo : !layer.mute) ? layer.weight : 0;
}

const exposure = () => Number(element('exposure').value);

function draw() {
  const sum = new Float32Array(3 * pixels);
  for (const layer of group.layers) {
    const weight = weightOf(layer);
    if (weight === 0) continue;
    for (let i = 0; i < sum.length; i++) sum[i] += weight * layer.values[i];
  }
  const gain = 2 ** exposure();
  show(element('picture'), content.width, content.height, sum, gain);
  for (const layer of group.layers) {
    const { width, height, values } = layer.small;
    show(layer.row.querySelector('.thumb'), width, height, values, gain);
  }
  tell();
}

function tell() {
  const words = group.layers.filter(weightOf).map(layer => {
    const weight = weightOf(layer);
    return weight === 1 ? layer.name : `${weight.toFixed(2)} × ${layer.name}`;
  });
  const text = words.length ? words.join(' + ') : 'darkness';
  element('caption').textContent = text;
  element('picture').setAttribute('aria-label', `The picture: ${text}`);
  const stops = exposure();
  element('stops').textContent = (stops > 0 ? '+' : stops < 0 ? '−' : '') + Math.abs(stops).toFixed(2);
  element('exposure').setAttribute('aria-valuetext', `${stops} stops`);
  for (const layer of group.layers) {
    const { row } = layer;
    row.classList.toggle('silent', weightOf(layer) === 0);
    row.querySelector('input').value = layer.weight;
    row.querySelector('output').textContent = layer.weight.toFixed(2);
    row.querySelector('.solo').setAttribute('aria-pressed', layer.solo);
    row.querySelector('.mute').setAttribute('aria-pressed', layer.mute);
  }
}

// Once for all events that wait (browsers send one of a slider for each frame).
let asked = false;
function drawSoon() {
  if (asked) return;
  asked = true;
  setTimeout(() => {
    asked = false;
    draw();
  });
}

/* Sliders and buttons. */

function rowOf(layer, number) {
  const row = element('row').content.cloneNode(true).querySelector('li');
  const [label, slider] = [row.querySelector('label'), row.querySelector('input')];
  label.textContent = layer.name;
  label.htmlFor = slider.id = `weight${number}`;
  row.querySelector('.share').textContent = `${(100 * layer.share).toPrecision(2)} %`;
  row.querySelector('.share').title = 'of the light of the picture';
  row.querySelector('small').textContent = layer.meaning;
  slider.addEventListener('input', () => {
    layer.weight = Number(slider.value);
    drawSoon();
  });
  for (const what of ['solo', 'mute']) {
    const button = row.querySelector(`.${what}`);
    button.setAttribute('aria-label', `${button.textContent} ${layer.name}`);
    button.addEventListener('click', () => {
      layer[what] = !layer[what];
      drawSoon();
    });
  }
  return row;
}

function choose(chosen) {
  group = chosen;
  element('layers').replaceChildren(...group.layers.map(layer => layer.row));
  drawSoon();
}

function offer(group, number) {
  const label = document.createElement('label');
  const radio = Object.assign(document.createElement('input'), { type: 'radio', name: 'group', id: `group${number}` });
  radio.defaultChecked = number === 0;
  radio.addEventListener('change', () => choose(group));
  label.append(radio, ` ${group.title}`);
  element('groups').append(label);
}

function asRendered() {
  for (const layer of layers) Object.assign(layer, { weight: 1, solo: false, mute: false });
  element('exposure').value = content.exposure;
  drawSoon();
}

element('exposure').addEventListener('input', drawSoon);
element('desk').addEventListener('submit', event => event.preventDefault());
element('desk').addEventListener('reset', event => {
  event.preventDefault(); // the group stays
  asRendered();
});
element('save').addEventListener('click', () => {
  const link = document.createElement('a');
  link.download = 'layers.png';
  link.href = element('picture').toDataURL('image/png');
  link.click();
});

async function begin() {
  const name = content.scene || 'Layers of light';
  document.title = element('title').textContent = name;
  const pixelSize = content.shrunk > 1 ? `, each the mean of ${content.shrunk} × ${content.shrunk} of the render` : '';
  element('size').textContent = `${content.width} × ${content.height} pixels${pixelSize}.`;
  element('made').textContent = content.made;
  element('picture').style.setProperty('--aspect', content.width / content.height);
  element('picture').style.setProperty('--columns', `${content.width}px`);
  if (typeof DecompressionStream === 'undefined') throw new Error('this browser cannot unpack it: try a newer one');
  await Promise.all(layers.map(async (layer, number) => {
    layer.values = await unpacked(layer.data);
    layer.data = null;
    layer.small = thumbnail(layer.values);
    layer.row = rowOf(layer, number);
  }));
  content.groups.forEach(offer);
  element('exposure').value = content.exposure;
  choose(group);
}

begin().catch(error => {
  element('caption').textContent = `The layers cannot be shown: ${error.message}`;
});
