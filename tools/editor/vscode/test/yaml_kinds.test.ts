import assert from 'node:assert/strict';
import { test } from 'node:test';

import { outermostKeys, schemaOf } from '../src/yaml_kinds';

test('only keys at the outermost level count', () => {
  assert.deepEqual(outermostKeys('# cases: x\na: 1\n  b: 2\nc:\n  - d: 1\n"e": 3\nf:x\n'), ['a', 'c']);
});

test('files of the program have their schemas', () => {
  assert.equal(schemaOf('defaults: {}\ncases:\n  - id: a\n'), 'suite.yaml');
  assert.equal(schemaOf('discrepancies:\n  - id: a\n'), 'ledger.yaml');
  assert.equal(schemaOf('quarantine:\n  - case: a\n'), 'quarantine.yaml');
  assert.equal(schemaOf('model: [a.e]\nplan: p.lisp\nhorizon: 3\n'), 'scenario.yaml');
  assert.equal(schemaOf('include: common.yaml\nexpect: {verdict: discrepancy}\n'), 'scenario.yaml');
  assert.equal(schemaOf('mapping: {}\nactions: {}\nregions: {}\n'), 'scenario.yaml');
  assert.equal(schemaOf('friction: {default: 0.5}\nbodies: {}\n'), 'world.yaml');
  assert.equal(schemaOf('models:\n  lost_traces: forbidden\nruns: {}\n'), 'gate.yaml');
});

test('files of other programs have none', () => {
  assert.equal(schemaOf('services:\n  web: {image: x}\ninclude: [a.yaml]\n'), undefined);
  assert.equal(schemaOf('name: CI\non: push\njobs: {}\n'), undefined);
  assert.equal(schemaOf('model: gpt\nname: x\n'), undefined);
  assert.equal(schemaOf('apiVersion: v1\nkind: Pod\n'), undefined);
  assert.equal(schemaOf('models:\n  - name: orders\n'), undefined);
  assert.equal(schemaOf(''), undefined);
});
