// Why a print stopped or waits, and why a file did not arrive, in the words of the chosen language.
import { t } from '../i18n/text.ts';
import type { DataOf, PauseReason, StopReason } from '../printer/messages.ts';
import type { PrintProblem } from '../printer/print-state.ts';
import type { ServerKind, UploadFault } from '../printer/upload.ts';

export function stopText(reason: StopReason): string {
  const { stops } = t.printing;
  switch (reason.kind) {
    case 'emergency_in_job':
      return stops.emergency_in_job(reason.line + 1);
    case 'printer_error':
      return stops.printer_error(reason.message);
    case 'resend_impossible':
      return stops.resend_impossible(reason.asked, reason.first, reason.last);
    case 'resend_loop':
      return stops.resend_loop(reason.number, reason.times);
    case 'bad_job_line':
      return stops.bad_job_line(reason.line + 1, faultText(reason.fault));
    default:
      return stops[reason.kind];
  }
}

type LineFault = Extract<DataOf<'stopped'>['reason'], { kind: 'bad_job_line' }>['fault'];

function faultText(fault: LineFault): string {
  const { faults } = t.printing;
  return fault.kind === 'too_long' ? faults.too_long(fault.bytes, fault.limit) : faults[fault.kind];
}

export function pauseText(reason: PauseReason): string {
  const { pauses } = t.printing;
  return reason.kind === 'job' ? pauses.job(reason.text) : pauses[reason.kind];
}

export function problemText(problem: PrintProblem): string {
  return problem.kind === 'lost' ? stopText(problem.reason) : t.printing.problems[problem.kind];
}

/** What went wrong, and what to do about it. */
export function uploadText(fault: UploadFault, server: ServerKind): string {
  const { faults } = t.printing.network;
  switch (fault.kind) {
    case 'policy':
      return faults.policy(fault.origin);
    case 'blocked':
      return `${faults.blocked} ${faults.allow[server]}`;
    case 'refused':
      return faults.refused(fault.status, fault.message);
    case 'address':
    case 'mixed':
    case 'key':
      return faults[fault.kind];
    case 'cancelled':
      return '';
    default:
      return fault satisfies never;
  }
}
