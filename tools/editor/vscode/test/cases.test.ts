import assert from 'node:assert/strict';
import { test } from 'node:test';

import { byFile, labelOf, placeOf, startsFor, stateOf, textOf } from '../src/cases';
import type { CaseResult } from '../src/documents';
import { outermost, verdictOf } from '../src/runs';

const cases = [
  { name: '/w/suite.yaml:b', file: '/w/suite.yaml', line: 7 },
  { name: '/w/suite.yaml:bb', file: '/w/suite.yaml', line: 9 },
  { name: '/w/edge.yaml', file: '/w/edge.yaml', line: 3 },
];

function result(outcome: string, more: Partial<CaseResult> = {}): CaseResult {
  return { name: 'n', outcome, problems: [], wallS: 0, line: 1, quarantined: undefined, ...more };
}

test('cases are put below their manifests, and scenarios are cases themselves', () => {
  const files = byFile(cases);
  assert.deepEqual(files.map((file) => [file.file, file.line, file.cases.length]), [
    ['/w/edge.yaml', 3, 0],
    ['/w/suite.yaml', 1, 2],
  ]);
  assert.equal(files[0]?.own?.name, '/w/edge.yaml');
  assert.deepEqual(files[1]?.cases.map(labelOf), ['b', 'bb']);
});

test('a file is started once if all of it is wanted, and a case by its whole name', () => {
  const [edge, suite] = byFile(cases);
  assert.ok(edge !== undefined && suite !== undefined);
  const names = (...list: string[]): Set<string> => new Set(list);
  assert.deepEqual(startsFor(edge, names('/w/edge.yaml')), [
    { path: '/w/edge.yaml', only: undefined, names: ['/w/edge.yaml'] },
  ]);
  assert.deepEqual(startsFor(suite, names('/w/suite.yaml:b')), [
    { path: '/w/suite.yaml', only: '/w/suite.yaml:b', names: ['/w/suite.yaml:b'] },
  ]);
  assert.equal(startsFor(suite, names('/w/suite.yaml:b', '/w/suite.yaml:bb')).length, 1);
  assert.deepEqual(startsFor(suite, names('/w/edge.yaml')), []);
});

test('outcomes', () => {
  assert.equal(stateOf(result('passed')), 'passed');
  assert.equal(stateOf(result('failed')), 'failed');
  assert.equal(stateOf(result('error')), 'errored');
  assert.equal(stateOf(result('inconclusive')), 'skipped');
  assert.equal(stateOf(result('not finished')), 'errored');
  assert.equal(stateOf(result('something new')), 'errored');
  assert.equal(stateOf(result('failed', { quarantined: 'known' })), 'skipped');
  assert.equal(textOf(result('failed', { problems: ['a'], quarantined: 'known' })), 'a\nin quarantine: known');
  assert.equal(textOf(result('inconclusive')), 'inconclusive');
});

test('the place of a problem is found where a terminal would show it', () => {
  const remarks = [
    'ERROR two_regions/scenario.yaml (0.0 s)',
    '       E2101: no fluent `Holdng`',
    '       /w/a:b/domain.e:21:16-21: error[E2101]: no fluent `Holdng`',
  ].join('\n');
  assert.deepEqual(placeOf(['E2101: no fluent `Holdng`'], remarks), { file: '/w/a:b/domain.e', line: 21, column: 16 });
  assert.equal(placeOf(['E2101: no fluent `Other`'], remarks), undefined);
});

test('further simulations of a run are no runs', () => {
  assert.deepEqual(outermost(['/o/edge', '/o/edge/further', '/o/edge-2', '/o/edge/x/half_step']), ['/o/edge', '/o/edge-2']);
});

test('the verdict of a report, also of a broken one', () => {
  assert.equal(verdictOf('{"verdict":"discrepancy"}'), 'discrepancy');
  for (const text of ['', '{', '{}', 'null', '{"verdict":1}']) assert.equal(verdictOf(text), 'not finished');
});
