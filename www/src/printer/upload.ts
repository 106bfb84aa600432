// Sends a file to a print server in the network: OctoPrint, Moonraker (Klipper) or PrusaLink.

export type ServerKind = 'octoprint' | 'moonraker' | 'prusalink';

export interface PrintServer {
  readonly kind: ServerKind;
  /** As the user typed it. */
  readonly address: string;
  readonly key: string;
}

/** Why a file did not arrive. */
export type UploadFault =
  | { readonly kind: 'address' }
  /** The page's own Content-Security-Policy does not allow the address. */
  | { readonly kind: 'policy'; readonly origin: string }
  /** A page by https may not talk to a server by http. */
  | { readonly kind: 'mixed' }
  /** Not reached, or the server does not let other pages talk to it: the browser does not say which. */
  | { readonly kind: 'blocked' }
  | { readonly kind: 'key' }
  | { readonly kind: 'refused'; readonly status: number; readonly message: string }
  | { readonly kind: 'cancelled' };

export class UploadError extends Error {
  readonly fault: UploadFault;

  constructor(fault: UploadFault) {
    super(fault.kind);
    this.fault = fault;
  }
}

/** The base of the server's addresses, with `http://` where none was typed; undefined when it is none. */
export function serverBase(address: string): URL | undefined {
  const typed = address.trim();
  const text = /^[a-z]+:\/\//i.test(typed) ? typed : `http://${typed}`;
  const url = /^\S+$/.test(typed) && URL.canParse(text) ? new URL(text.replace(/\/*$/, '/')) : undefined;
  return url !== undefined && /^https?:$/.test(url.protocol) ? url : undefined;
}

interface Wanted {
  readonly method: 'POST' | 'PUT';
  readonly url: URL;
  readonly headers: Readonly<Record<string, string>>;
  readonly body: FormData | Blob;
}

/** What each server wants to be asked; after its own documentation of the HTTP interface. */
export function requestFor(server: PrintServer, base: URL, name: string, text: Blob, print: boolean): Wanted {
  const headers: Record<string, string> = server.key === '' ? {} : { 'X-Api-Key': server.key };
  const form = (fields: Readonly<Record<string, string>>): FormData => {
    const data = new FormData();
    for (const [key, value] of Object.entries(fields)) data.append(key, value);
    data.append('file', text, name);
    return data;
  };
  switch (server.kind) {
    case 'octoprint':
      return {
        method: 'POST',
        url: new URL('api/files/local', base),
        headers,
        body: form({ select: String(print), print: String(print) }),
      };
    case 'moonraker':
      return {
        method: 'POST',
        url: new URL('server/files/upload', base),
        headers,
        body: form({ root: 'gcodes', print: String(print) }),
      };
    case 'prusalink':
      return {
        method: 'PUT',
        url: new URL(`api/v1/files/usb/${encodeURIComponent(name)}`, base),
        headers: {
          ...headers,
          'Content-Type': 'text/x.gcode',
          Overwrite: '?1',
          'Print-After-Upload': print ? '?1' : '?0',
        },
        body: text,
      };
    default:
      return server.kind satisfies never;
  }
}

/** Resolves when the server has the file; rejects with an UploadError. `progress` gets 0 to 1. */
export function upload(
  server: PrintServer,
  file: { readonly name: string; readonly text: Blob; readonly print: boolean },
  signal: AbortSignal,
  progress: (share: number) => void,
): Promise<void> {
  const base = serverBase(server.address);
  if (base === undefined) return Promise.reject(new UploadError({ kind: 'address' }));
  const { method, url, headers, body } = requestFor(server, base, file.name, file.text, file.print);
  return new Promise((resolve, reject) => {
    let policy = false;
    const violated = (event: SecurityPolicyViolationEvent): void => {
      policy ||= event.effectiveDirective === 'connect-src';
    };
    document.addEventListener('securitypolicyviolation', violated);
    const request = new XMLHttpRequest();
    const end = (settle: () => void): void => {
      document.removeEventListener('securitypolicyviolation', violated);
      settle();
    };
    const fail = (fault: UploadFault): void => end(() => reject(new UploadError(fault)));
    request.open(method, url);
    for (const [key, value] of Object.entries(headers)) request.setRequestHeader(key, value);
    request.upload.onprogress = ({ loaded, total }) => progress(total > 0 ? loaded / total : 0);
    request.onload = () => (request.status < 300 ? end(resolve) : fail(refusal(request)));
    // The report of a violated policy may come a moment after the failure.
    request.onerror = () => setTimeout(() => fail(blockedBy(policy, url)), 50);
    request.onabort = () => fail({ kind: 'cancelled' });
    signal.addEventListener('abort', () => request.abort());
    request.send(body);
  });
}

function refusal({ status, statusText, responseText }: XMLHttpRequest): UploadFault {
  if (status === 401 || status === 403) return { kind: 'key' };
  return { kind: 'refused', status, message: (responseText || statusText).slice(0, 300) };
}

function blockedBy(policy: boolean, url: URL): UploadFault {
  if (policy) return { kind: 'policy', origin: url.origin };
  return location.protocol === 'https:' && url.protocol === 'http:' ? { kind: 'mixed' } : { kind: 'blocked' };
}
