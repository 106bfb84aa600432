// Sends the file to a print server in the network.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { PrintFile } from '../printer/print-session.ts';
import type { PrintServer, ServerKind } from '../printer/upload.ts';
import { PrintPart } from './print-part.ts';
import { uploadText } from './print-words.ts';

const KINDS: readonly ServerKind[] = ['octoprint', 'moonraker', 'prusalink'];

/** Where the server is kept, if the user asks for it. */
const KEY = 'foothold-print-server';

export class PrintNetwork extends PrintPart {
  static override properties = { ...PrintPart.properties, file: { attribute: false } };
  declare file: (() => PrintFile) | undefined;

  #server: PrintServer = { kind: 'octoprint', address: '', key: '' };
  #keep = false;
  #start = false;

  constructor() {
    super();
    this.file = undefined;
    const kept = keptServer();
    if (kept === undefined) return;
    this.#server = kept;
    this.#keep = true;
  }

  protected override render(): TemplateResult {
    const words = t.printing.network;
    const running = this.print.upload.kind === 'running';
    return html`<details class="card network">
      <summary>${words.heading}</summary>
      <form @submit=${this.#submit}>
        <label class="line">
          <span>${words.server}</span>
          <select aria-label=${words.server} @change=${(event: Event) => this.#change({ kind: (event.target as HTMLSelectElement).value as ServerKind })}>
            ${KINDS.map((it) => html`<option value=${it} ?selected=${it === this.#server.kind}>${words.names[it]}</option>`)}
          </select>
        </label>
        ${this.#text(words.address, 'address', 'text')} ${this.#text(words.key, 'key', 'password')}
        ${this.#check(words.start, this.#start, (on) => {
          this.#start = on;
        })}
        ${this.#check(words.keep, this.#keep, (on) => {
          this.#keep = on;
          this.#remember();
        })}
        <div class="row buttons">
          ${
            running
              ? html`<button type="button" class="button" @click=${() => this.printing?.cancelUpload()}>${words.cancel}</button>`
              : html`<button type="submit" class="button" aria-disabled=${this.file === undefined}>${words.send}</button>`
          }
        </div>
      </form>
      ${this.file === undefined ? html`<p class="hint">${t.printing.nothing}</p>` : nothing} ${this.#state()}
    </details>`;
  }

  #state(): TemplateResult | typeof nothing {
    const { upload } = this.print;
    const words = t.printing.network;
    switch (upload.kind) {
      case 'idle':
        return nothing;
      case 'running':
        return html`<progress aria-label=${words.progress} max="1" .value=${upload.share}></progress>`;
      case 'done':
        return html`<p role="status">${words.done}</p>`;
      case 'failed':
        return html`<p class="problem" role="alert">${uploadText(upload.fault, this.#server.kind)}</p>`;
      default:
        return upload satisfies never;
    }
  }

  #text(label: string, name: 'address' | 'key', type: string): TemplateResult {
    return html`<label class="line">
      <span>${label}</span>
      <input
        type=${type}
        .value=${this.#server[name]}
        autocomplete="off"
        spellcheck="false"
        placeholder=${name === 'address' ? 'http://octopi.local' : ''}
        @change=${(event: Event) => this.#change({ [name]: (event.target as HTMLInputElement).value })}
      />
    </label>`;
  }

  #check(label: string, on: boolean, set: (on: boolean) => void): TemplateResult {
    return html`<label class="check">
      <input type="checkbox" .checked=${on} @change=${(event: Event) => set((event.target as HTMLInputElement).checked)} />
      ${label}
    </label>`;
  }

  #change(change: Partial<PrintServer>): void {
    this.#server = { ...this.#server, ...change };
    this.#remember();
    this.requestUpdate();
  }

  /** Kept only while the user wants it; forgotten at once when not. */
  #remember(): void {
    try {
      if (this.#keep) localStorage.setItem(KEY, JSON.stringify(this.#server));
      else localStorage.removeItem(KEY);
    } catch {
      // A browser that keeps nothing.
    }
  }

  #submit = (event: SubmitEvent): void => {
    event.preventDefault();
    if (this.file !== undefined) void this.printing?.upload(this.#server, this.file(), this.#start);
  };
}

function keptServer(): PrintServer | undefined {
  try {
    const kept = JSON.parse(localStorage.getItem(KEY) ?? 'null') as Partial<PrintServer> | null;
    const { kind, address, key } = kept ?? {};
    const whole = KINDS.some((it) => it === kind) && typeof address === 'string' && typeof key === 'string';
    return whole ? ({ kind, address, key } as PrintServer) : undefined;
  } catch {
    return undefined;
  }
}

customElements.define('print-network', PrintNetwork);
