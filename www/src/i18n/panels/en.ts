// The words of the panels and lessons, in English.

/** A fact of the step shown, written as the language does, with so many digits after the point at most. */
export type Fact = (name: string, digits?: number) => string;

export const panels = {
  waiting: 'Drawing…',
  stop: 'Stop',
  base: {
    heading: 'How shall it stick?',
    kinds: { none: 'Nothing', skirt: 'Skirt', brim: 'Brim', raft: 'Raft', teeth: 'Teeth' },
    what: {
      none: 'The part alone on the bed.',
      skirt: 'A loop beside the part: it fills the nozzle and holds nothing.',
      brim: 'Loops that touch the outline all round: holds well, is cut off.',
      raft: 'Layers below the part: holds most, uses most.',
      teeth: 'A rail with teeth that bite into the outline: holds, then tears off like a stamp.',
    },
    picture: (kind: string) => `The first layer with this around or below it: ${kind}`,
    best: 'Suits this part',
    plain: 'The first layer is broad and round: it holds by itself.',
    why: (reasons: string) => `Something should hold it: ${reasons}.`,
    reasons: {
      sharp_corners: 'sharp corners lift',
      long: 'it is long, and shrinkage adds up',
      thin: 'its first layer is thin',
      small: 'little of it touches the bed',
      material: 'the material shrinks',
    },
    all: 'All figures',
    kind: 'Kind',
    filament: 'Filament',
    time: 'Time',
    contact: 'On the bed',
    attachment: 'Holds',
    attachmentHelp: 'Length of the part’s outline that it holds, and its share of all outlines',
    computed: 'Computed in',
    teeth: (placed: string, bites: string) => `${placed} teeth, biting ${bites} mm`,
  },
  plane: {
    heading: 'Supports from the side',
    open: 'Look through the part',
    axis: 'Plane across',
    place: 'Place of the plane',
    picture: (plane: string) => `Section at ${plane} mm with what hangs, the points S, IO and G, and the support`,
    figures: (area: string, zero: string) => `Support here ${area} mm², ${zero} mm² if every downward face were held`,
    beside: 'The plane does not meet the part.',
    legend: { hanging: 'hangs', held: 'support', zero: 'only at angle 0', s: 'S-point', io: 'IO-point', g: 'G-point' },
  },
  zones: {
    heading: 'Boxes for supports',
    hint: 'In an enforcer every downward face is held, in a blocker none. Millimetres on the bed.',
    enforcers: 'Enforcer',
    blockers: 'Blocker',
    addEnforcer: 'Add enforcer',
    addBlocker: 'Add blocker',
    remove: (name: string) => `Remove ${name}`,
    low: 'from',
    high: 'to',
    axis: (name: string, axis: string, end: string) => `${name}: ${axis} ${end}, mm`,
  },
  orientation: {
    heading: 'Which way up?',
    find: 'Compare directions',
    again: 'Compare again',
    hint: 'Supports are computed for six directions and the sides that the part can lie on.',
    progress: 'Comparing directions',
    candidate: (id: number) => `Direction ${id}`,
    as: 'as it lies',
    chosen: 'least support',
    best: 'hard to beat',
    bestHelp: 'No other direction is at least as good in volume, structures and height.',
    pick: 'Turn it this way',
    picked: 'This way up',
    undo: 'Undo turning',
    flat: 'Lay a face flat',
    flatHint: 'Click a face of the part: it will lie on the bed.',
    figures: {
      support: 'Support',
      filament: 'Filament for it',
      structures: 'Structures',
      contact: 'On the bed',
      height: 'Height',
      time: 'Time, roughly',
      scars: 'Scarred area',
    },
    chart: 'Support volume against structures',
    chartVolume: 'Support volume, cm³',
    chartStructures: 'Structures',
    network: 'The network and the exact comparison',
    networkSays: 'Network says minimum',
    exactSays: 'Exact minimum',
    agree: 'Both agree.',
    differ: 'They differ; the exact comparison decides.',
    yes: 'yes',
    no: 'no',
  },
  learn: {
    heading: 'How it works',
    lessons: {
      teeth: 'Brim teeth',
      plates: 'Thin plates',
      features: 'What needs support',
      orientation: 'Which way up',
    },
    steps: 'Steps',
    next: 'Next',
    previous: 'Back',
    of: (step: number, total: number) => `Step ${step} of ${total}`,
    change: 'Try other numbers',
    link: 'Copy link',
    copied: 'The address is copied: it opens this picture with these numbers.',
    ownModel: 'The link carries your numbers, but not your own file.',
    paper: 'as printed in the paper',
    ours: 'as Foothold prints them',
    sheets: 'all plates',
    layer: 'one layer from above',
    plane: 'Plane',
    layerBelow: 'Layer',
    noModel: 'Open a model first.',
    source: {
      teeth:
        'After N. Lv, Y. Li, Y. Qiao: Generation Algorithm of a Novel Platform Attached Support Structure for FDM, 2022.',
      plates:
        'After B. Zhao, S. Wang, F. Xie: Research on Automatic Generation Algorithm for the Supporting Structure in FDM Process.',
      features:
        'After K. F. Karim et al.: Feature-Based Support Generation for Optimum Part Deposition Orientation in FDM.',
      orientation:
        'After K. F. Karim et al.: Feature-Based Support Generation for Optimum Part Deposition Orientation in FDM.',
    },
    teeth: {
      outline: {
        title: 'Outline',
        text: (n: Fact) =>
          `Outlines of the first layer: ${n('contours')}, with ${n('vertices')} corners, ${n('length', 1)} mm long in all. Everything is measured to this printed outline.`,
      },
      offset: {
        title: 'Offset',
        text: (n: Fact) =>
          `Each of ${n('vertices')} corners moves outward until it is ${n('offset', 2)} mm from both of its edges. The green line through them is the rail.`,
      },
      simplify: {
        title: 'Simplify',
        text: (n: Fact) =>
          `Corners closer than ${n('min_length', 2)} mm to the last one and less than ${n('min_height', 2)} mm off the line are dropped (red). ${n('before')} become ${n('after')}.`,
      },
      divide: {
        title: 'Divide',
        text: (n: Fact) =>
          `Every edge is cut into parts of about ${n('pitch', 1)} mm, each with a base of ${n('base', 1)} mm from A to B: ${n('teeth')} teeth. ${n('short_edges')} of ${n('edges')} edges are too short for any.`,
      },
      tips: {
        title: 'Tips',
        text: (n: Fact) =>
          `Above each base a tip stands ${n('height', 1)} mm from the rail, so it bites ${n('bite', 2)} mm. ${n('biting')} tips lie in the part, ${n('outside')} point past it (red).`,
      },
      path: {
        title: 'Path',
        text: (n: Fact) =>
          `Rail and teeth are one closed line of ${n('length', 1)} mm, drawn in one go. It takes ${n('filament', 1)} mm³ of plastic.`,
      },
      compare: {
        title: 'Printed and improved',
        text: (n: Fact) =>
          `Left the paper’s way: ${n('paper_biting')} of ${n('paper')} teeth bite. Right what Foothold prints: ${n('ours_biting')} of ${n('ours')}, each ${n('bite_min', 2)} to ${n('bite_max', 2)} mm deep, none on a corner.`,
      },
    },
    plates: {
      plane: {
        title: 'Plane',
        text: (n: Fact) =>
          `${n('planes')} upright planes cross under the part. We look at the one at ${n('at', 1)} mm (pink).`,
      },
      contour: {
        title: 'Contour',
        text: (n: Fact) =>
          `Contours of the part in this plane: ${n('contours')}, ${n('area', 0)} mm² in all. ${n('hanging', 1)} mm of them hang past the angle (red).`,
      },
      points: {
        title: 'Points',
        text: (n: Fact) =>
          `Where a contour turns from down to up stands an S-point: ${n('s')}, of them ${n('type_b')} below another contour. Straight below lies an IO-point on the part (${n('io')}) or a G-point on the bed (${n('g')}).`,
      },
      region: {
        title: 'Region',
        text: (n: Fact) =>
          `Between what hangs and what lies below it the support fills ${n('area', 1)} mm² (green). Were every downward face held, as in the paper, it would be ${n('at_zero', 1)} mm² (pale).`,
      },
      crossing: {
        title: 'Crossing',
        text: (n: Fact) =>
          `${n('plates')} plates in both directions hold each other and come out in ${n('pieces')} piece(s). They take ${n('volume', 0)} mm³ instead of ${n('complete', 0)} mm³ for a full block.`,
      },
    },
    features: {
      layers: {
        title: 'Two layers',
        text: (n: Fact) =>
          `Layer ${n('layer')} covers ${n('below', 0)} mm² (grey), the one above it ${n('above', 0)} mm² (blue). What of the upper one has nothing below it?`,
      },
      grown: {
        title: 'Grown layer',
        text: (n: Fact) =>
          `A layer of ${n('height', 2)} mm may reach ${n('step', 3)} mm past the one below, as a lean of ${n('angle', 0)}° holds itself. So the lower layer is grown by that (yellow).`,
      },
      overhang: {
        title: 'Overhang',
        text: (n: Fact) =>
          `Of ${n('pieces')} piece(s) that overhang, ${n('features')} reach out of the grown layer: these need support, whole (red, ${n('area', 1)} mm²). The others (blue, ${n('held', 1)} mm²) hold themselves.`,
      },
      regions: {
        title: 'Regions grow down',
        text: (n: Fact) =>
          `From the top down each layer hands its region to the one below, less the part itself. Over ${n('layers')} layers that makes ${n('volume', 0)} mm³.`,
      },
      structures: {
        title: 'Structures',
        text: (n: Fact) =>
          `Regions that touch from layer to layer are one structure (one colour): with the base ${n('structures')}. Support ${n('support', 0)} mm³ and base ${n('base', 0)} mm³ make ${n('total', 0)} mm³.`,
      },
    },
    orientation: {
      volumes: {
        title: 'Six volumes',
        text: (n: Fact) =>
          `The part is turned six ways, and the supports of each are computed. They need from ${n('smallest', 0)} to ${n('largest', 0)} mm³.`,
      },
      matrix: {
        title: 'Matrix',
        text: (n: Fact) =>
          `The volumes, as shares of the largest, stand in six rows, each beginning with its own direction. The framed row ${n('row')} begins with ${n('own', 3)}.`,
      },
      network: {
        title: 'Network',
        text: (n: Fact) =>
          `One small network reads a row; ${n('firing')} of its ${n('hidden')} units fire for row ${n('row')}. Its evidence is ${n('evidence', 2)}: above zero means “my first is the smallest”.`,
      },
      choice: {
        title: 'Choice',
        text: (n: Fact) =>
          `Among the smallest (O₁, and exactly: min) the fewest structures n decide: R, then O₂. Direction ${n('chosen')} it is, with ${n('volume', 0)} mm³ in ${n('structures')} structure(s).`,
      },
    },
  },
};

export type PanelWords = typeof panels;
