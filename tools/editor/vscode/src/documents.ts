// What the program's documents say, checked and typed. `parallax schema COMMAND` describes them;
// fields that nothing here shows are left out.

/** A document is not as this extension knows it, so the program is an older or newer one. */
export class ShapeError extends Error {
  constructor(place: string) {
    super(`parallax printed a document without ${place}. Extension and program may differ in age.`);
  }
}

export interface Place {
  file: string;
  line: number;
  column: number;
}

export interface Message {
  severity: string;
  code: string;
  message: string;
  help: string;
  notes: string[];
  place: Place | undefined;
}

export interface Timepoint {
  time: number;
  happens: string[];
  holds: string[];
  released: string[];
}

export interface Trace {
  number: number;
  timepoints: Timepoint[];
  predicates: string[];
  ended: string;
}

export interface Traces {
  kind: 'traces';
  isComplete: boolean;
  list: Trace[];
}

export interface Axiom {
  place: Place;
  what: string;
  text: string;
  instances: string[];
}

export interface Difference {
  fluent: string;
  timepoint: number;
  predicted: boolean;
  observed: boolean;
}

export interface Contradictions {
  kind: 'contradictions';
  sets: { axioms: Axiom[]; words: string }[];
  isComplete: boolean;
  cause: string;
  differences: Difference[];
}

export interface Step {
  fact: string;
  why: string;
  axiom: Axiom | undefined;
  premises: string[];
  absent: string[];
}

export interface Reasons {
  kind: 'reasons';
  trace: number;
  fact: string;
  steps: Step[];
}

export interface Case {
  name: string;
  file: string;
  /** From 1; of a case without a place 1. */
  line: number;
}

export interface CaseResult {
  name: string;
  outcome: string;
  problems: string[];
  wallS: number;
  line: number | undefined;
  /** Why a failure does not count, for cases in quarantine. */
  quarantined: string | undefined;
}

export interface RunResult {
  verdict: string;
  simulations: number;
  causes: string[];
}

type Json = Record<string, unknown>;

function isObject(value: unknown): value is Json {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

function objectOf(value: unknown, place: string): Json {
  if (!isObject(value)) throw new ShapeError(place);
  return value;
}

function textOf(json: Json, name: string): string {
  const value = json[name];
  if (typeof value !== 'string') throw new ShapeError(name);
  return value;
}

function numberOf(json: Json, name: string): number {
  const value = json[name];
  if (typeof value !== 'number') throw new ShapeError(name);
  return value;
}

function objectsOf(json: Json, name: string): Json[] {
  const value = json[name];
  if (!Array.isArray(value)) throw new ShapeError(name);
  return value.map((item) => objectOf(item, name));
}

/** Texts of a list; one that is missing is empty. */
function textsOf(json: Json, name: string): string[] {
  const value = json[name] ?? [];
  if (!Array.isArray(value) || !value.every((item) => typeof item === 'string')) {
    throw new ShapeError(name);
  }
  return value;
}

function optionalText(json: Json, name: string): string {
  return json[name] === undefined ? '' : textOf(json, name);
}

/** The messages of a document: those of an error, or remarks beside an answer. */
export function messagesOf(document: Json): Message[] {
  if (document['diagnostics'] === undefined) return [];
  return objectsOf(document, 'diagnostics').map((one) => ({
    severity: textOf(one, 'severity'),
    code: textOf(one, 'code'),
    message: textOf(one, 'message'),
    help: optionalText(one, 'help'),
    notes: objectsOf(one, 'notes').map((note) => textOf(note, 'message')),
    place:
      one['path'] === undefined || one['line'] === undefined
        ? undefined
        : { file: textOf(one, 'path'), line: numberOf(one, 'line'), column: columnOf(one) },
  }));
}

function columnOf(json: Json): number {
  return typeof json['column'] === 'number' ? json['column'] : 1;
}

/** Is there no answer? Its messages then say why. */
export function isError(document: Json): boolean {
  return document['status'] !== 'ok' && document['list'] === undefined;
}

export function tracesOf(document: Json): Traces {
  return {
    kind: 'traces',
    isComplete: document['complete'] === true,
    list: objectsOf(document, 'list').map((trace) => ({
      number: numberOf(trace, 'trace'),
      predicates: textsOf(trace, 'predicates'),
      ended: optionalText(trace, 'ended'),
      timepoints: objectsOf(trace, 'timepoints').map((point) => ({
        time: numberOf(point, 'time'),
        happens: textsOf(point, 'happens'),
        holds: textsOf(point, 'holds'),
        released: textsOf(point, 'released'),
      })),
    })),
  };
}

function axiomOf(json: Json): Axiom {
  return {
    place: { file: textOf(json, 'file'), line: numberOf(json, 'line'), column: columnOf(json) },
    what: textOf(json, 'what'),
    text: textOf(json, 'text'),
    instances: textsOf(json, 'instances'),
  };
}

export function explanationOf(document: Json): Contradictions | Reasons {
  if (document['steps'] !== undefined) {
    return {
      kind: 'reasons',
      trace: numberOf(document, 'trace'),
      fact: textOf(document, 'fact'),
      steps: objectsOf(document, 'steps').map((step) => ({
        fact: textOf(step, 'fact'),
        why: textOf(step, 'why'),
        axiom: step['axiom'] === undefined ? undefined : axiomOf(objectOf(step['axiom'], 'axiom')),
        premises: textsOf(step, 'premises'),
        absent: textsOf(step, 'absent'),
      })),
    };
  }
  return {
    kind: 'contradictions',
    isComplete: document['satisfiable'] === true || document['complete'] === true,
    cause: optionalText(document, 'cause_words'),
    sets: objectsOf(document, 'sets').map((set) => ({
      axioms: objectsOf(set, 'axioms').map(axiomOf),
      words: optionalText(set, 'words'),
    })),
    differences: (document['differences'] === undefined ? [] : objectsOf(document, 'differences')).map(
      (one) => ({
        fluent: textOf(one, 'fluent'),
        timepoint: numberOf(one, 'timepoint'),
        predicted: one['predicted'] === true,
        observed: one['observed'] === true,
      }),
    ),
  };
}

export function casesOf(document: Json): Case[] {
  return objectsOf(document, 'cases').map((one) => ({
    name: textOf(one, 'case'),
    file: textOf(one, 'file'),
    line: one['line'] === undefined ? 1 : numberOf(one, 'line'),
  }));
}

export function resultsOf(document: Json): CaseResult[] {
  return objectsOf(document, 'cases').map((one) => ({
    name: textOf(one, 'case'),
    outcome: textOf(one, 'outcome'),
    problems: textsOf(one, 'problems'),
    wallS: numberOf(objectOf(one['timing'], 'timing'), 'wall_s'),
    line: one['line'] === undefined ? undefined : numberOf(one, 'line'),
    quarantined: one['quarantined'] === undefined ? undefined : textOf(one, 'quarantined'),
  }));
}

export function runResultOf(document: Json): RunResult {
  const causes = objectsOf(document, 'discrepancies').map((one) =>
    textOf(objectOf(one['cause'], 'cause'), 'text'),
  );
  return {
    verdict: textOf(document, 'verdict'),
    simulations: numberOf(document, 'simulations'),
    causes: [...new Set(causes)],
  };
}
