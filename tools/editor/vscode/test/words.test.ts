import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
  collectWords,
  explainRunWords,
  explainWords,
  freeName,
  reportWords,
  runWords,
  suiteWords,
  traceWords,
} from '../src/words';

const allowed = { allowCommands: true };
const forbidden = { allowCommands: false };

test('names of files stay one word, whatever is in them', () => {
  assert.deepEqual(traceWords('/a b/$(x); y.e', 5), ['traces', '/a b/$(x); y.e', '--json', '--limit', '5']);
  assert.deepEqual(reportWords('/out/a', '/p.html'), ['report', '/out/a', '--json', '-o', '/p.html']);
  assert.deepEqual(collectWords('/w'), ['suite', '/w', '--json', '--collect-only']);
});

test('a fact of the user cannot be taken for an option', () => {
  assert.deepEqual(explainWords('/m.e', ' --allow-commands '), ['explain', '/m.e', '--json', '--why=--allow-commands']);
  assert.deepEqual(explainWords('/m.e', '  '), ['explain', '/m.e', '--json']);
  assert.ok(suiteWords('/s.yaml', '-x', '/o', forbidden).includes('--only=-x'));
});

test('commands of scenarios are permitted by the setting alone', () => {
  assert.deepEqual(runWords('/s.yaml', '/o', forbidden).slice(-1), ['--no-commands']);
  assert.deepEqual(runWords('/s.yaml', '/o', allowed).slice(-1), ['--allow-commands']);
  for (const words of [explainRunWords('/o', forbidden), suiteWords('/s', undefined, '/o', forbidden)]) {
    assert.ok(!words.includes('--allow-commands'));
  }
  for (const words of [explainRunWords('/o', allowed), suiteWords('/s', undefined, '/o', allowed)]) {
    assert.ok(words.includes('--allow-commands'));
  }
});

test('run folders are numbered as the program numbers them', () => {
  const taken = new Set(['edge', 'edge-2']);
  assert.equal(freeName('edge', (name) => taken.has(name)), 'edge-3');
  assert.equal(freeName('other', (name) => taken.has(name)), 'other');
});
