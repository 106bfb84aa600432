// Settings as a caller names them: those that it wants otherwise than the profiles have them.
import type { Settings } from '../generated/settings.ts';

/** Some of the settings, nested by stage as in a settings file. */
export type SomeSettings = Partly<Settings>;

type Partly<T> = T extends readonly unknown[] ? T : T extends object ? { [K in keyof T]?: Partly<T[K]> } : T;
