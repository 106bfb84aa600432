// Numbers, times and amounts as a language writes them.

export interface Formats {
  /** A number with so many digits after the point at most. */
  number(value: number, digits: number): string;
  /** Two numbers as "0.3–0.4", one where they look the same. */
  range(low: number, high: number, digits: number): string;
  /** 44 × 24 × 48 mm */
  size(size: readonly number[]): string;
  volume(mm3: number): string;
  metres(mm: number): string;
  grams(g: number): string;
  money(amount: number): string;
  /** Seconds as a person says them: "1 h 5 min", "42 s". */
  duration(seconds: number): string;
}

/** Names of time units: hours, minutes, seconds. */
export type TimeUnits = readonly [h: string, min: string, s: string];

export function formats(locale: string, [h, min, s]: TimeUnits): Formats {
  const number = (value: number, digits: number): string =>
    new Intl.NumberFormat(locale, { maximumFractionDigits: digits }).format(value);
  // What is there is not told as 0.
  const amount = (value: number, digits: number): string =>
    value > 0 && value < 0.5 * 10 ** -digits ? `< ${number(10 ** -digits, digits)}` : number(value, digits);
  const twoDigits = new Intl.NumberFormat(locale, { minimumFractionDigits: 2, maximumFractionDigits: 2 });
  return {
    number,
    range: (low, high, digits) => [...new Set([number(low, digits), number(high, digits)])].join('–'),
    size: (size) => `${size.map((length) => number(length, 1)).join(' × ')} mm`,
    volume: (mm3) => `${amount(mm3 / 1000, 1)} cm³`,
    metres: (mm) => `${amount(mm / 1000, 2)} m`,
    grams: (g) => `${amount(g, 1)} g`,
    money: (amount) => twoDigits.format(amount),
    duration: (seconds) => {
      const minutes = Math.round(seconds / 60);
      if (seconds < 60) return `${Math.round(seconds)} ${s}`;
      if (minutes < 60) return `${minutes} ${min}`;
      const [hours, rest] = [Math.floor(minutes / 60), minutes % 60];
      return rest === 0 ? `${hours} ${h}` : `${hours} ${h} ${rest} ${min}`;
    },
  };
}

/** Units as a person writes them; the others stay as the engine names them. */
export function unitSign(name: string): string {
  return { degrees: '°', 'degrees C': '°C', 'mm/s2': 'mm/s²', 'mm3/s': 'mm³/s', 'g/cm3': 'g/cm³' }[name] ?? name;
}
