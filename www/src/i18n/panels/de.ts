// Die Wörter der Tafeln und Lektionen, auf Deutsch.
import type { Fact, PanelWords } from './en.ts';

export const panels: PanelWords = {
  waiting: 'Wird gezeichnet …',
  stop: 'Anhalten',
  base: {
    heading: 'Wie soll es haften?',
    kinds: { none: 'Nichts', skirt: 'Umrandung', brim: 'Rand', raft: 'Floß', teeth: 'Zähne' },
    what: {
      none: 'Das Teil allein auf dem Druckbett.',
      skirt: 'Eine Schleife neben dem Teil: füllt die Düse und hält nichts.',
      brim: 'Schleifen, die den Umriss ringsum berühren: hält gut, wird abgeschnitten.',
      raft: 'Schichten unter dem Teil: hält am meisten, braucht am meisten.',
      teeth: 'Eine Schiene mit Zähnen, die in den Umriss beißen: hält und reißt dann ab wie eine Briefmarke.',
    },
    picture: (kind) => `Die erste Schicht mit dem, was darum oder darunter liegt: ${kind}`,
    best: 'Passt zu diesem Teil',
    plain: 'Die erste Schicht ist breit und rund: Sie hält von selbst.',
    why: (reasons) => `Etwas sollte es halten: ${reasons}.`,
    reasons: {
      sharp_corners: 'spitze Ecken heben sich',
      long: 'es ist lang, und Schwund summiert sich',
      thin: 'die erste Schicht ist schmal',
      small: 'wenig davon berührt das Bett',
      material: 'das Material schrumpft',
    },
    all: 'Alle Zahlen',
    kind: 'Art',
    filament: 'Material',
    time: 'Zeit',
    contact: 'Auf dem Bett',
    attachment: 'Hält',
    attachmentHelp: 'Länge des Umrisses, die gehalten wird, und ihr Anteil an allen Umrissen',
    computed: 'Berechnet in',
    teeth: (placed, bites) => `${placed} Zähne, ${bites} mm tief`,
  },
  plane: {
    heading: 'Stützen von der Seite',
    open: 'Durch das Teil schauen',
    axis: 'Ebene quer zu',
    place: 'Ort der Ebene',
    picture: (plane) => `Schnitt bei ${plane} mm mit dem, was hängt, den Punkten S, IO und G und der Stütze`,
    figures: (area, zero) => `Stütze hier ${area} mm², ${zero} mm², wenn alles gestützt würde, was nach unten zeigt`,
    beside: 'Die Ebene trifft das Teil nicht.',
    legend: { hanging: 'hängt', held: 'Stütze', zero: 'nur bei Winkel 0', s: 'S-Punkt', io: 'IO-Punkt', g: 'G-Punkt' },
  },
  zones: {
    heading: 'Kästen für Stützen',
    hint: 'Im Erzwinger wird alles gestützt, was nach unten zeigt, im Sperrer nichts. Millimeter auf dem Bett.',
    enforcers: 'Erzwinger',
    blockers: 'Sperrer',
    addEnforcer: 'Erzwinger hinzufügen',
    addBlocker: 'Sperrer hinzufügen',
    remove: (name) => `${name} entfernen`,
    low: 'von',
    high: 'bis',
    axis: (name, axis, end) => `${name}: ${axis} ${end}, mm`,
  },
  orientation: {
    heading: 'Welche Seite nach oben?',
    find: 'Richtungen vergleichen',
    again: 'Noch einmal vergleichen',
    hint: 'Stützen werden für sechs Richtungen und die Seiten berechnet, auf denen das Teil liegen kann.',
    progress: 'Richtungen werden verglichen',
    candidate: (id) => `Richtung ${id}`,
    as: 'wie es liegt',
    chosen: 'am wenigsten Stützen',
    best: 'kaum zu schlagen',
    bestHelp: 'Keine andere Richtung ist in Volumen, Stützkörpern und Höhe mindestens so gut.',
    pick: 'So herum drehen',
    picked: 'Liegt so herum',
    undo: 'Drehung zurücknehmen',
    flat: 'Fläche auflegen',
    flatHint: 'Auf eine Fläche des Teils klicken: Sie kommt auf das Bett.',
    figures: {
      support: 'Stützen',
      filament: 'Filament dafür',
      structures: 'Stützkörper',
      contact: 'Auf dem Bett',
      height: 'Höhe',
      time: 'Zeit, ungefähr',
      scars: 'Narben',
    },
    chart: 'Stützvolumen und Stützkörper',
    chartVolume: 'Stützvolumen, cm³',
    chartStructures: 'Stützkörper',
    network: 'Das Netz und der genaue Vergleich',
    networkSays: 'Minimum laut Netz',
    exactSays: 'Minimum genau',
    agree: 'Beide sind sich einig.',
    differ: 'Sie sind verschiedener Meinung; der genaue Vergleich entscheidet.',
    yes: 'ja',
    no: 'nein',
  },
  learn: {
    heading: 'So geht es',
    lessons: {
      teeth: 'Randzähne',
      plates: 'Dünne Platten',
      features: 'Was Stützen braucht',
      orientation: 'Welche Seite nach oben',
    },
    steps: 'Schritte',
    next: 'Weiter',
    previous: 'Zurück',
    of: (step, total) => `Schritt ${step} von ${total}`,
    change: 'Andere Zahlen probieren',
    link: 'Link kopieren',
    copied: 'Die Adresse ist kopiert: Sie öffnet dieses Bild mit diesen Zahlen.',
    ownModel: 'Der Link trägt deine Zahlen, aber nicht deine eigene Datei.',
    paper: 'wie im Aufsatz gedruckt',
    ours: 'wie Foothold sie druckt',
    sheets: 'alle Platten',
    layer: 'eine Schicht von oben',
    plane: 'Ebene',
    layerBelow: 'Schicht',
    noModel: 'Zuerst ein Modell öffnen.',
    source: {
      teeth:
        'Nach N. Lv, Y. Li, Y. Qiao: Generation Algorithm of a Novel Platform Attached Support Structure for FDM, 2022.',
      plates:
        'Nach B. Zhao, S. Wang, F. Xie: Research on Automatic Generation Algorithm for the Supporting Structure in FDM Process.',
      features:
        'Nach K. F. Karim et al.: Feature-Based Support Generation for Optimum Part Deposition Orientation in FDM.',
      orientation:
        'Nach K. F. Karim et al.: Feature-Based Support Generation for Optimum Part Deposition Orientation in FDM.',
    },
    teeth: {
      outline: {
        title: 'Umriss',
        text: (n: Fact) =>
          `Umrisse der ersten Schicht: ${n('contours')}, mit ${n('vertices')} Ecken, zusammen ${n('length', 1)} mm lang. Alles wird bis zu diesem gedruckten Umriss gemessen.`,
      },
      offset: {
        title: 'Versetzen',
        text: (n: Fact) =>
          `Jede von ${n('vertices')} Ecken rückt nach außen, bis sie ${n('offset', 2)} mm von ihren beiden Kanten entfernt ist. Die grüne Linie hindurch ist die Schiene.`,
      },
      simplify: {
        title: 'Vereinfachen',
        text: (n: Fact) =>
          `Ecken, die der letzten näher als ${n('min_length', 2)} mm sind und weniger als ${n('min_height', 2)} mm abweichen, fallen weg (rot). Aus ${n('before')} werden ${n('after')}.`,
      },
      divide: {
        title: 'Teilen',
        text: (n: Fact) =>
          `Jede Kante wird in Stücke von etwa ${n('pitch', 1)} mm geteilt, jedes mit einem Fuß von ${n('base', 1)} mm von A nach B: ${n('teeth')} Zähne. ${n('short_edges')} von ${n('edges')} Kanten sind zu kurz dafür.`,
      },
      tips: {
        title: 'Spitzen',
        text: (n: Fact) =>
          `Über jedem Fuß steht ${n('height', 1)} mm von der Schiene eine Spitze, sie beißt also ${n('bite', 2)} mm. ${n('biting')} Spitzen liegen im Teil, ${n('outside')} zeigen daran vorbei (rot).`,
      },
      path: {
        title: 'Bahn',
        text: (n: Fact) =>
          `Schiene und Zähne sind eine geschlossene Linie von ${n('length', 1)} mm, in einem Zug. Sie braucht ${n('filament', 1)} mm³ Material.`,
      },
      compare: {
        title: 'Gedruckt und verbessert',
        text: (n: Fact) =>
          `Links wie im Aufsatz: ${n('paper_biting')} von ${n('paper')} Zähnen beißen. Rechts, was Foothold druckt: ${n('ours_biting')} von ${n('ours')}, jeder ${n('bite_min', 2)} bis ${n('bite_max', 2)} mm tief, keiner auf einer Ecke.`,
      },
    },
    plates: {
      plane: {
        title: 'Ebene',
        text: (n: Fact) =>
          `${n('planes')} senkrechte Ebenen kreuzen sich unter dem Teil. Wir betrachten die bei ${n('at', 1)} mm (rosa).`,
      },
      contour: {
        title: 'Kontur',
        text: (n: Fact) =>
          `Konturen des Teils in dieser Ebene: ${n('contours')}, zusammen ${n('area', 0)} mm². ${n('hanging', 1)} mm davon hängen über den Winkel hinaus (rot).`,
      },
      points: {
        title: 'Punkte',
        text: (n: Fact) =>
          `Wo eine Kontur von abwärts nach aufwärts dreht, steht ein S-Punkt: ${n('s')}, davon ${n('type_b')} unter einer anderen Kontur. Senkrecht darunter liegt ein IO-Punkt auf dem Teil (${n('io')}) oder ein G-Punkt auf dem Bett (${n('g')}).`,
      },
      region: {
        title: 'Gebiet',
        text: (n: Fact) =>
          `Zwischen dem, was hängt, und dem, was darunter liegt, füllt die Stütze ${n('area', 1)} mm² (grün). Würde wie im Aufsatz alles gestützt, was nach unten zeigt, wären es ${n('at_zero', 1)} mm² (blass).`,
      },
      crossing: {
        title: 'Kreuzung',
        text: (n: Fact) =>
          `${n('plates')} Platten in beiden Richtungen halten einander und lösen sich in ${n('pieces')} Stück(en). Sie brauchen ${n('volume', 0)} mm³ statt ${n('complete', 0)} mm³ für einen vollen Block.`,
      },
    },
    features: {
      layers: {
        title: 'Zwei Schichten',
        text: (n: Fact) =>
          `Schicht ${n('layer')} bedeckt ${n('below', 0)} mm² (grau), die darüber ${n('above', 0)} mm² (blau). Was von der oberen hat nichts unter sich?`,
      },
      grown: {
        title: 'Gewachsene Schicht',
        text: (n: Fact) =>
          `Eine Schicht von ${n('height', 2)} mm darf ${n('step', 3)} mm über die untere hinausragen, denn eine Neigung von ${n('angle', 0)}° trägt sich selbst. Um so viel wächst die untere (gelb).`,
      },
      overhang: {
        title: 'Überhang',
        text: (n: Fact) =>
          `Von ${n('pieces')} überhängenden Stück(en) ragen ${n('features')} aus der gewachsenen Schicht: Sie brauchen ganz eine Stütze (rot, ${n('area', 1)} mm²). Die anderen (blau, ${n('held', 1)} mm²) tragen sich selbst.`,
      },
      regions: {
        title: 'Gebiete wachsen abwärts',
        text: (n: Fact) =>
          `Von oben nach unten reicht jede Schicht ihr Gebiet weiter, ohne das Teil selbst. Über ${n('layers')} Schichten macht das ${n('volume', 0)} mm³.`,
      },
      structures: {
        title: 'Stützkörper',
        text: (n: Fact) =>
          `Gebiete, die sich von Schicht zu Schicht berühren, sind ein Stützkörper (eine Farbe): mit der Basis ${n('structures')}. Stützen ${n('support', 0)} mm³ und Basis ${n('base', 0)} mm³ machen ${n('total', 0)} mm³.`,
      },
    },
    orientation: {
      volumes: {
        title: 'Sechs Volumen',
        text: (n: Fact) =>
          `Das Teil wird sechsmal gedreht, und jedes Mal werden die Stützen berechnet. Sie brauchen ${n('smallest', 0)} bis ${n('largest', 0)} mm³.`,
      },
      matrix: {
        title: 'Matrix',
        text: (n: Fact) =>
          `Die Volumen stehen als Anteile des größten in sechs Zeilen, jede beginnt mit der eigenen Richtung. Die gerahmte Zeile ${n('row')} beginnt mit ${n('own', 3)}.`,
      },
      network: {
        title: 'Netz',
        text: (n: Fact) =>
          `Ein kleines Netz liest eine Zeile; ${n('firing')} seiner ${n('hidden')} Einheiten feuern für Zeile ${n('row')}. Es meldet ${n('evidence', 2)}: über null heißt „meine erste ist die kleinste“.`,
      },
      choice: {
        title: 'Wahl',
        text: (n: Fact) =>
          `Unter den kleinsten (O₁, und genau: min) entscheiden die wenigsten Stützkörper n: R, dann O₂. Es wird Richtung ${n('chosen')} mit ${n('volume', 0)} mm³ in ${n('structures')} Stützkörper(n).`,
      },
    },
  },
};
