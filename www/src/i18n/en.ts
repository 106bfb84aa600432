// Every word of the page's own; labels and help of settings come from the engine.

const number = (digits: number): Intl.NumberFormat => new Intl.NumberFormat('en', { maximumFractionDigits: digits });

export const en = {
  title: 'Foothold',
  tagline: 'From an STL to G-code, in this page. Nothing is uploaded.',
  loading: 'Starting the engine…',
  sample: 'Sample bracket',
  model: {
    heading: 'Model',
    open: 'Open model',
    hint: 'or drop an STL file anywhere',
    drop: 'Drop the STL file to open it',
    reading: (name: string) => `Reading ${name}…`,
    size: ([x, y, z]: readonly number[]) =>
      `${number(1).format(x ?? 0)} × ${number(1).format(y ?? 0)} × ${number(1).format(z ?? 0)} mm`,
    triangles: (count: number) => `${number(0).format(count)} ${count === 1 ? 'triangle' : 'triangles'}`,
    volume: (mm3: number) => `${number(1).format(mm3 / 1000)} cm³`,
    opened: (name: string) => `${name} is open.`,
    badAddress:
      'The address of the page names a model on another site. Only a model beside the page can be opened this way.',
    notFound: (name: string) => `${name} was not found beside the page.`,
  },
  job: {
    heading: 'Job',
    slice: 'Slice',
    cancel: 'Cancel',
    download: 'Download G-code',
    progress: 'Progress',
    stages: { read: 'Reading', prepare: 'Preparing', layers: 'Slicing', join: 'Writing' },
    layers: (done: number, total: number) => `layer ${done} of ${total}`,
    stale: 'Settings have changed: slice again to use them.',
    cancelled: 'Cancelled.',
    done: (layers: number, time: string) => `Sliced: ${layers} layers, printing takes ${time}.`,
    percent: (share: number) => `${Math.round(100 * share)} % sliced`,
  },
  view: {
    heading: 'View',
    model: 'Model',
    layers: 'Layers',
    choice: 'What to show',
    sides: { iso: 'Corner', top: 'Top', front: 'Front' },
    side: 'Seen from',
    zoomIn: 'Zoom in',
    zoomOut: 'Zoom out',
    fit: 'Show all',
    canvas: 'Picture: arrow keys move it, plus and minus zoom, 0 shows all',
    modelPicture: (name: string) => `Picture of ${name} on the bed`,
    layerPicture: (layer: number, total: number) => `Paths of layer ${layer} of ${total}`,
    layer: 'Layer',
    layerValue: (layer: number, total: number, z: string) => `Layer ${layer} of ${total}${z === '' ? '' : `, ${z} mm`}`,
    next: 'Next layer',
    previous: 'Previous layer',
    empty: 'Slice the model to see its layers.',
  },
  figures: {
    heading: 'Result',
    empty: 'Time, filament and cost stand here once the model is sliced.',
    time: 'Time',
    filament: 'Filament',
    mass: 'Mass',
    cost: 'Cost',
    layers: 'Layers',
    metres: (mm: number) => `${number(2).format(mm / 1000)} m`,
    grams: (g: number) => `${number(1).format(g)} g`,
    money: (amount: number) => amount.toFixed(2),
    duration,
    legend: 'What each colour costs',
    role: 'Path',
    thisLayer: 'This layer',
    length: 'Length',
    share: 'Time',
    warnings: 'Remarks',
    showLayer: (layer: number) => `Show layer ${layer}`,
  },
  settings: {
    heading: 'Settings',
    basic: 'Most used',
    all: 'All settings',
    general: 'General',
    reset: (label: string, value: string) => `Set ${label} back to ${value}`,
    changed: 'changed',
    range: (low: string, high: string, unit: string) => `From ${low} to ${high}${unit === '' ? '' : ` ${unit}`}`,
    whole: 'A whole number, please',
    number: 'A number, please',
    /** Units as a person writes them; the others stay as the engine names them. */
    unit: (name: string) => ({ 'degrees C': '°C', 'mm/s2': 'mm/s²', 'mm3/s': 'mm³/s', 'g/cm3': 'g/cm³' })[name] ?? name,
  },
  problem: {
    ModelError: { title: 'This model can’t be used', advice: 'Export it again as STL, or open another one.' },
    SettingsError: { title: 'A setting is not right', advice: 'Correct it and slice again.' },
    FitError: {
      title: 'It does not fit the printer',
      advice: 'Choose a larger bed or height in the printer settings, or a smaller model.',
    },
    InternalError: {
      title: 'The engine broke',
      advice: 'That is a fault of ours. A new engine was started with your model: change a setting or try again.',
    },
  },
} as const;

export type ProblemName = keyof typeof en.problem;

/** Seconds as a person says them: "1 h 5 min", "42 s". */
function duration(seconds: number): string {
  const minutes = Math.round(seconds / 60);
  if (seconds < 60) return `${Math.round(seconds)} s`;
  if (minutes < 60) return `${minutes} min`;
  const [hours, rest] = [Math.floor(minutes / 60), minutes % 60];
  return rest === 0 ? `${hours} h` : `${hours} h ${rest} min`;
}
