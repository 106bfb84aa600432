// The words of the page in German.
import type { Words } from './en.ts';
import { formats, unitSign } from './format.ts';
import { print } from './print.de.ts';

const format = formats('de', ['h', 'min', 's']);

export const de: Words = {
  language: 'Deutsch',
  format,
  title: 'Foothold',
  tagline: 'Vom STL zum G-Code, in dieser Seite. Nichts wird hochgeladen.',
  loading: 'Das Rechenwerk startet …',
  steps: {
    heading: 'Schritte',
    prepare: 'Vorbereiten',
    preview: 'Vorschau',
    print: 'Drucken',
    learn: 'Lernen',
  },
  page: {
    language: 'Sprache',
    dark: 'Dunkle Farben',
  },
  model: {
    heading: 'Modell',
    open: 'Modell öffnen',
    hint: 'oder eine STL-Datei irgendwo ablegen',
    drop: 'Loslassen, um die STL-Datei zu öffnen',
    reading: (name) => `${name} wird gelesen …`,
    triangles: (count) => `${format.number(count, 0)} ${count === 1 ? 'Dreieck' : 'Dreiecke'}`,
    opened: (name) => `${name} ist geöffnet.`,
    badAddress:
      'Die Adresse der Seite nennt ein Modell auf einer anderen Website. So lässt sich nur ein Modell neben der Seite öffnen.',
    notFound: (name) => `${name} liegt nicht neben der Seite.`,
  },
  job: {
    heading: 'Auftrag',
    slice: 'Slicen',
    cancel: 'Abbrechen',
    download: 'G-Code herunterladen',
    progress: 'Fortschritt',
    stages: { read: 'Lesen', orient: 'Ausrichten', prepare: 'Vorbereiten', layers: 'Slicen', join: 'Schreiben' },
    layers: (done, total) => `Schicht ${done} von ${total}`,
    stale: 'Die Einstellungen sind geändert: neu slicen, damit sie gelten.',
    cancelled: 'Abgebrochen.',
    done: (layers, time) => `Gesliced: ${layers} Schichten, der Druck dauert ${time}.`,
    percent: (share) => `${Math.round(100 * share)} % gesliced`,
  },
  view: {
    heading: 'Ansicht',
    sides: { iso: 'Ecke', top: 'Oben', front: 'Vorn' },
    side: 'Gesehen von',
    zoomIn: 'Näher',
    zoomOut: 'Weiter weg',
    fit: 'Alles zeigen',
    canvas: 'Bild: Pfeiltasten verschieben, Plus und Minus zoomen, 0 zeigt alles',
    modelPicture: (name) => `Bild von ${name} auf dem Druckbett`,
    layerPicture: (layer, total) => `Bahnen der Schicht ${layer} von ${total}`,
    layer: 'Schicht',
    layerValue: (layer, total, z) => `Schicht ${layer} von ${total}${z === '' ? '' : `, ${z} mm`}`,
    next: 'Nächste Schicht',
    previous: 'Vorige Schicht',
    empty: 'Das Modell slicen, um seine Schichten zu sehen.',
  },
  figures: {
    heading: 'Ergebnis',
    empty: 'Zeit, Filament und Kosten stehen hier, sobald das Modell gesliced ist.',
    time: 'Zeit',
    filament: 'Filament',
    mass: 'Masse',
    cost: 'Kosten',
    layers: 'Schichten',
    legend: 'Was jede Farbe kostet',
    role: 'Bahn',
    thisLayer: 'Schicht',
    length: 'Länge',
    share: 'Zeit',
    warnings: 'Hinweise',
    showLayer: (layer) => `Schicht ${layer} zeigen`,
  },
  settings: {
    heading: 'Einstellungen',
    all: 'Alle Einstellungen',
    general: 'Allgemein',
    reset: (label, value) => `${label} auf ${value} zurücksetzen`,
    changed: 'geändert',
    range: (low, high, unit) => `Von ${low} bis ${high}${unit === '' ? '' : ` ${unit}`}`,
    whole: 'Bitte eine ganze Zahl',
    number: 'Bitte eine Zahl',
    unit: unitSign,
  },
  printing: print,
  problem: {
    ModelError: {
      title: 'Dieses Modell ist nicht brauchbar',
      advice: 'Noch einmal als STL ausgeben oder ein anderes öffnen.',
    },
    SettingsError: { title: 'Eine Einstellung stimmt nicht', advice: 'Berichtigen und noch einmal slicen.' },
    FitError: {
      title: 'Es passt nicht in den Drucker',
      advice: 'In den Druckereinstellungen ein größeres Bett oder mehr Höhe wählen, oder ein kleineres Modell.',
    },
    InternalError: {
      title: 'Das Rechenwerk ist abgestürzt',
      advice:
        'Das ist unser Fehler. Ein neues wurde mit dem Modell gestartet: eine Einstellung ändern oder noch einmal versuchen.',
    },
  },
};
