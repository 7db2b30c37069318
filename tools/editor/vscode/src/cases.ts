// Cases of suites as a tree, what to start for a selection, and what an answer means for a test.

import type { Case, CaseResult, Place } from './documents';

/** A manifest with its cases, or a scenario, which is one case and has no children. */
export interface CaseFile {
  file: string;
  line: number;
  /** The case of a scenario; undefined for a manifest. */
  own: Case | undefined;
  cases: Case[];
}

export function byFile(cases: readonly Case[]): CaseFile[] {
  const files = new Map<string, CaseFile>();
  for (const one of cases) {
    const known = files.get(one.file) ?? { file: one.file, line: 1, own: undefined, cases: [] };
    files.set(one.file, known);
    if (one.name === one.file) {
      known.own = one;
      known.line = one.line;
    } else {
      known.cases.push(one);
    }
  }
  return [...files.values()].sort((a, b) => (a.file < b.file ? -1 : a.file > b.file ? 1 : 0));
}

/** The id of a case in its manifest: names are `FILE:ID`. */
export function labelOf(one: Case): string {
  return one.name.startsWith(`${one.file}:`) ? one.name.slice(one.file.length + 1) : one.name;
}

export interface SuiteStart {
  path: string;
  /** Undefined: every case of the file. */
  only: string | undefined;
  /** The names of the cases whose results are wanted. `--only` may select more. */
  names: string[];
}

/** One start for each file whose cases are all wanted, else one for each case. */
export function startsFor(file: CaseFile, wanted: ReadonlySet<string>): SuiteStart[] {
  const all = file.own === undefined ? file.cases : [file.own];
  const chosen = all.filter((one) => wanted.has(one.name)).map((one) => one.name);
  if (chosen.length === 0) return [];
  if (chosen.length === all.length) return [{ path: file.file, only: undefined, names: chosen }];
  return chosen.map((name) => ({ path: file.file, only: name, names: [name] }));
}

export type TestState = 'passed' | 'failed' | 'errored' | 'skipped';

/** An inconclusive case is neither passed nor failed, and one in quarantine may fail. */
export function stateOf(result: CaseResult): TestState {
  switch (result.outcome) {
    case 'passed':
      return 'passed';
    case 'failed':
      return result.quarantined === undefined ? 'failed' : 'skipped';
    case 'error':
      return result.quarantined === undefined ? 'errored' : 'skipped';
    case 'inconclusive':
    case 'skipped':
    case 'removed':
      return 'skipped';
    default:
      return 'errored';
  }
}

/** The text of a result that is not a pass. */
export function textOf(result: CaseResult): string {
  const lines = result.problems.length === 0 ? [result.outcome] : result.problems;
  const kept = result.quarantined === undefined ? [] : [`in quarantine: ${result.quarantined}`];
  return [...lines, ...kept].join('\n');
}

/**
 * The place of a problem of the form `E2101: text`, from the lines that a terminal shows
 * (`FILE:LINE:COLUMN-COLUMN: error[E2101]: text`).
 */
export function placeOf(problems: readonly string[], remarks: string): Place | undefined {
  for (const line of remarks.split('\n')) {
    const found = /^\s*(.+?):(\d+):(\d+)\S*: (?:error|warning)\[([EW]\d{4})\]: (.*)$/.exec(line);
    if (found === null) continue;
    const [, file = '', row = '1', column = '1', code = '', text = ''] = found;
    if (problems.includes(`${code}: ${text}`)) {
      return { file, line: Number(row), column: Number(column) };
    }
  }
  return undefined;
}
