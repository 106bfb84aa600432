// The shop's part: a price from the slicer's report.
const slicer = document.querySelector('foothold-slicer');
const quote = document.querySelector('.quote output');
const order = document.querySelector('.quote button');

const PER_KG = 45;
const PER_HOUR = 1.5;

slicer.addEventListener('foothold-sliced', ({ detail: report }) => {
  const price = (report.filament.mass_g / 1000) * PER_KG + (report.time_s / 3600) * PER_HOUR;
  quote.textContent = `${price.toFixed(2)} € for ${report.filament.mass_g.toFixed(1)} g of PETG`;
  order.disabled = false;
});

slicer.addEventListener('foothold-error', ({ detail }) => {
  quote.textContent = `No price: ${detail.message}`;
  order.disabled = true;
});

order.addEventListener('click', () => {
  const file = slicer.gcode();
  quote.textContent = `Ordered: ${file.name}, ${Math.round(file.size / 1024)} KiB`;
});
