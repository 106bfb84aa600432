// Every word of the page's own, in English; labels and help of settings come from the engine.
// The other tables have the type of this one: a word that they lack does not compile.
import { formats, unitSign } from './format.ts';
import { print } from './print.en.ts';

const format = formats('en', ['h', 'min', 's']);

export const en = {
  /** What the language calls itself. */
  language: 'English',
  format,
  title: 'Foothold',
  tagline: 'From an STL to G-code, in this page. Nothing is uploaded.',
  loading: 'Starting the engine…',
  steps: {
    heading: 'Steps',
    prepare: 'Prepare',
    preview: 'Preview',
    print: 'Print',
    learn: 'Learn',
  },
  page: {
    language: 'Language',
    dark: 'Dark colours',
  },
  model: {
    heading: 'Model',
    open: 'Open model',
    hint: 'or drop an STL file anywhere',
    drop: 'Drop the STL file to open it',
    reading: (name: string) => `Reading ${name}…`,
    triangles: (count: number) => `${format.number(count, 0)} ${count === 1 ? 'triangle' : 'triangles'}`,
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
    stages: { read: 'Reading', orient: 'Orienting', prepare: 'Preparing', layers: 'Slicing', join: 'Writing' },
    layers: (done: number, total: number) => `layer ${done} of ${total}`,
    stale: 'Settings have changed: slice again to use them.',
    cancelled: 'Cancelled.',
    done: (layers: number, time: string) => `Sliced: ${layers} layers, printing takes ${time}.`,
    percent: (share: number) => `${Math.round(100 * share)} % sliced`,
  },
  view: {
    heading: 'View',
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
    all: 'All settings',
    general: 'General',
    reset: (label: string, value: string) => `Set ${label} back to ${value}`,
    changed: 'changed',
    range: (low: string, high: string, unit: string) => `From ${low} to ${high}${unit === '' ? '' : ` ${unit}`}`,
    whole: 'A whole number, please',
    number: 'A number, please',
    unit: unitSign,
  },
  printing: print,
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
};

/** The words of a language. */
export type Words = typeof en;

export type ProblemName = keyof Words['problem'];
