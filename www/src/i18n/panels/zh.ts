// 面板与课程的文字，中文。
import type { Fact, PanelWords } from './en.ts';

export const panels: PanelWords = {
  waiting: '正在绘制…',
  stop: '停止',
  base: {
    heading: '怎样粘住热床？',
    kinds: { none: '无', skirt: '裙边', brim: '帽檐', raft: '筏层', teeth: '齿边' },
    what: {
      none: '只有零件本身。',
      skirt: '零件旁的一圈：用来充满喷嘴，不起固定作用。',
      brim: '贴着轮廓的多圈线：粘得牢，需要切除。',
      raft: '零件下面的几层：最牢，也最费料。',
      teeth: '带齿的导轨咬住轮廓：打印时固定，之后像邮票一样撕下。',
    },
    picture: (kind) => `首层及其周围或下面的结构：${kind}`,
    best: '适合这个零件',
    plain: '首层宽而圆：自身就能粘住。',
    why: (reasons) => `需要固定：${reasons}。`,
    reasons: {
      sharp_corners: '尖角容易翘起',
      long: '零件长，收缩会累积',
      thin: '首层很窄',
      small: '与热床接触很少',
      material: '材料会收缩',
    },
    all: '全部数据',
    kind: '种类',
    filament: '耗材',
    time: '时间',
    contact: '接触热床',
    attachment: '固定',
    attachmentHelp: '被固定的轮廓长度，及其占全部轮廓的比例',
    computed: '计算用时',
    teeth: (placed, bites) => `${placed} 个齿，咬入 ${bites} mm`,
  },
  plane: {
    heading: '从侧面看支撑',
    open: '看零件内部',
    axis: '平面垂直于',
    place: '平面位置',
    picture: (plane) => `${plane} mm 处的截面：悬空处、S、IO、G 点和支撑`,
    figures: (area, zero) => `此处支撑 ${area} mm²；若所有朝下的面都支撑则为 ${zero} mm²`,
    beside: '该平面没有切到零件。',
    legend: { hanging: '悬空', held: '支撑', zero: '仅角度为 0 时', s: 'S 点', io: 'IO 点', g: 'G 点' },
  },
  zones: {
    heading: '支撑区域盒',
    hint: '强制盒内所有朝下的面都支撑，禁止盒内都不支撑。单位为热床上的毫米。',
    enforcers: '强制盒',
    blockers: '禁止盒',
    addEnforcer: '添加强制盒',
    addBlocker: '添加禁止盒',
    remove: (name) => `删除${name}`,
    low: '从',
    high: '到',
    axis: (name, axis, end) => `${name}：${axis} ${end}，mm`,
  },
  orientation: {
    heading: '哪面朝上？',
    find: '比较方向',
    again: '重新比较',
    hint: '对六个方向以及零件能平放的各面计算支撑。',
    progress: '正在比较方向',
    candidate: (id) => `方向 ${id}`,
    as: '当前方向',
    chosen: '支撑最少',
    best: '难以超越',
    bestHelp: '没有别的方向在体积、支撑数和高度上都不逊于它。',
    pick: '转到这个方向',
    picked: '已是这个方向',
    undo: '撤销旋转',
    flat: '把面放平',
    flatHint: '点击零件的一个面：它将贴在热床上。',
    figures: {
      support: '支撑',
      filament: '支撑耗材',
      structures: '支撑数',
      contact: '接触热床',
      height: '高度',
      time: '大致时间',
      scars: '留痕面积',
    },
    chart: '支撑体积与支撑数',
    chartVolume: '支撑体积，cm³',
    chartStructures: '支撑数',
    network: '网络与精确比较',
    networkSays: '网络认为最小',
    exactSays: '精确最小',
    agree: '两者一致。',
    differ: '两者不同，以精确比较为准。',
    yes: '是',
    no: '否',
  },
  learn: {
    heading: '原理',
    lessons: { teeth: '齿边', plates: '薄板支撑', features: '哪里需要支撑', orientation: '哪面朝上' },
    steps: '步骤',
    next: '下一步',
    previous: '上一步',
    of: (step, total) => `第 ${step} 步，共 ${total} 步`,
    change: '换些数字试试',
    link: '复制链接',
    copied: '地址已复制：打开它就能看到这幅图和这些数字。',
    ownModel: '链接带有你的数字，但不含你自己的文件。',
    paper: '论文中的样子',
    ours: 'Foothold 打印的样子',
    sheets: '全部薄板',
    layer: '从上方看一层',
    plane: '平面',
    layerBelow: '层',
    noModel: '请先打开模型。',
    source: {
      teeth:
        '依据 N. Lv、Y. Li、Y. Qiao：Generation Algorithm of a Novel Platform Attached Support Structure for FDM，2022。',
      plates:
        '依据 B. Zhao、S. Wang、F. Xie：Research on Automatic Generation Algorithm for the Supporting Structure in FDM Process。',
      features:
        '依据 K. F. Karim 等：Feature-Based Support Generation for Optimum Part Deposition Orientation in FDM。',
      orientation:
        '依据 K. F. Karim 等：Feature-Based Support Generation for Optimum Part Deposition Orientation in FDM。',
    },
    teeth: {
      outline: {
        title: '轮廓',
        text: (n: Fact) =>
          `首层有 ${n('contours')} 条轮廓、${n('vertices')} 个顶点，总长 ${n('length', 1)} mm。一切都以这条打印出的轮廓为准。`,
      },
      offset: {
        title: '偏移',
        text: (n: Fact) =>
          `${n('vertices')} 个顶点各自向外移动，直到离两条边都是 ${n('offset', 2)} mm。穿过它们的绿线就是导轨。`,
      },
      simplify: {
        title: '简化',
        text: (n: Fact) =>
          `离上一点不到 ${n('min_length', 2)} mm 且偏离不到 ${n('min_height', 2)} mm 的顶点被去掉（红色）。${n('before')} 个变成 ${n('after')} 个。`,
      },
      divide: {
        title: '等分',
        text: (n: Fact) =>
          `每条边分成约 ${n('pitch', 1)} mm 的小段，每段有从 A 到 B 长 ${n('base', 1)} mm 的齿根：共 ${n('teeth')} 个齿。${n('edges')} 条边中有 ${n('short_edges')} 条太短，没有齿。`,
      },
      tips: {
        title: '齿尖',
        text: (n: Fact) =>
          `齿尖离导轨 ${n('height', 1)} mm，因此咬入 ${n('bite', 2)} mm。${n('biting')} 个齿尖在零件内，${n('outside')} 个落在外面（红色）。`,
      },
      path: {
        title: '路径',
        text: (n: Fact) => `导轨和齿是一条长 ${n('length', 1)} mm 的封闭线，一笔画成。耗料 ${n('filament', 1)} mm³。`,
      },
      compare: {
        title: '论文与改进',
        text: (n: Fact) =>
          `左边按论文：${n('paper')} 个齿中 ${n('paper_biting')} 个咬住。右边是 Foothold 打印的：${n('ours')} 个中 ${n('ours_biting')} 个，每个深 ${n('bite_min', 2)} 至 ${n('bite_max', 2)} mm，都不在拐角上。`,
      },
    },
    plates: {
      plane: {
        title: '平面',
        text: (n: Fact) => `${n('planes')} 个竖直平面在零件下交叉。我们看 ${n('at', 1)} mm 处的那个（粉色）。`,
      },
      contour: {
        title: '轮廓',
        text: (n: Fact) =>
          `平面把零件切出 ${n('contours')} 条轮廓，共 ${n('area', 0)} mm²。其中 ${n('hanging', 1)} mm 超过角度而悬空（红色）。`,
      },
      points: {
        title: '特征点',
        text: (n: Fact) =>
          `轮廓由朝下转为朝上的地方是 S 点：${n('s')} 个，其中 ${n('type_b')} 个在别的轮廓之下。正下方是零件上的 IO 点（${n('io')} 个）或热床上的 G 点（${n('g')} 个）。`,
      },
      region: {
        title: '区域',
        text: (n: Fact) =>
          `悬空处与其下方之间由支撑填满 ${n('area', 1)} mm²（绿色）。若像论文那样支撑所有朝下的面，则为 ${n('at_zero', 1)} mm²（浅色）。`,
      },
      crossing: {
        title: '交叉',
        text: (n: Fact) =>
          `两个方向的 ${n('plates')} 块薄板互相支持，取下时为 ${n('pieces')} 件。用料 ${n('volume', 0)} mm³，而实心块需要 ${n('complete', 0)} mm³。`,
      },
    },
    features: {
      layers: {
        title: '两层',
        text: (n: Fact) =>
          `第 ${n('layer')} 层覆盖 ${n('below', 0)} mm²（灰色），上面一层 ${n('above', 0)} mm²（蓝色）。上层的哪些地方下面是空的？`,
      },
      grown: {
        title: '扩大的层',
        text: (n: Fact) =>
          `${n('height', 2)} mm 的层可以伸出下层 ${n('step', 3)} mm，因为 ${n('angle', 0)}° 的倾斜能自支撑。下层就扩大这么多（黄色）。`,
      },
      overhang: {
        title: '悬垂',
        text: (n: Fact) =>
          `${n('pieces')} 块悬垂中有 ${n('features')} 块超出扩大的层：它们整块需要支撑（红色，${n('area', 1)} mm²）。其余（蓝色，${n('held', 1)} mm²）能自支撑。`,
      },
      regions: {
        title: '区域向下生长',
        text: (n: Fact) =>
          `从上到下，每层把区域交给下一层，减去零件本身。经过 ${n('layers')} 层，共 ${n('volume', 0)} mm³。`,
      },
      structures: {
        title: '支撑体',
        text: (n: Fact) =>
          `层与层之间相连的区域是一个支撑体（同一颜色）：连同底座共 ${n('structures')} 个。支撑 ${n('support', 0)} mm³ 加底座 ${n('base', 0)} mm³，合计 ${n('total', 0)} mm³。`,
      },
    },
    orientation: {
      volumes: {
        title: '六个体积',
        text: (n: Fact) => `零件转六个方向，每个方向都计算支撑。需要 ${n('smallest', 0)} 到 ${n('largest', 0)} mm³。`,
      },
      matrix: {
        title: '矩阵',
        text: (n: Fact) =>
          `体积按最大值折算，排成六行，每行从自己的方向开始。加框的第 ${n('row')} 行以 ${n('own', 3)} 开头。`,
      },
      network: {
        title: '网络',
        text: (n: Fact) =>
          `一个小网络读一行；对第 ${n('row')} 行，${n('hidden')} 个单元中有 ${n('firing')} 个激活。输出 ${n('evidence', 2)}：大于零表示“我的第一个最小”。`,
      },
      choice: {
        title: '选择',
        text: (n: Fact) =>
          `在最小的方向（O₁，精确值：min）中，支撑体数 n 最少者胜：先 R，后 O₂。选方向 ${n('chosen')}：${n('volume', 0)} mm³，${n('structures')} 个支撑体。`,
      },
    },
  },
};
