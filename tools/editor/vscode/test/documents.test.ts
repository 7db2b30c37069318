import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
  ShapeError,
  casesOf,
  explanationOf,
  isError,
  messagesOf,
  resultsOf,
  runResultOf,
  tracesOf,
} from '../src/documents';

test('traces', () => {
  const traces = tracesOf({
    status: 'ok',
    traces: 1,
    complete: false,
    list: [{ trace: 1, timepoints: [{ time: 0, happens: ['Press()'], holds: [] }], predicates: ['P(A)'] }],
  });
  assert.equal(traces.isComplete, false);
  assert.deepEqual(traces.list[0]?.timepoints, [{ time: 0, happens: ['Press()'], holds: [], released: [] }]);
  assert.deepEqual(traces.list[0]?.predicates, ['P(A)']);
});

test('a document of another shape is refused, and the message says what is missing', () => {
  for (const document of [{}, { list: 1 }, { list: [1] }, { list: [{ trace: 1, timepoints: [{ time: '0' }] }] }]) {
    assert.throws(() => tracesOf(document), ShapeError);
  }
  assert.throws(() => tracesOf({ list: [{ timepoints: [] }] }), /without trace/);
  assert.throws(() => casesOf({ cases: [{ case: 'a', file: 3 }] }), /without file/);
  assert.throws(() => resultsOf({ cases: [{ case: 'a', outcome: 'passed', problems: [1] }] }), /without problems/);
});

test('messages have a place where the program gives one', () => {
  const document = {
    status: 'error',
    diagnostics: [
      { path: '/m.e', line: 3, column: 4, severity: 'error', code: 'E2101', message: 'no fluent', notes: [], help: 'h' },
      { path: '/n.e', severity: 'error', code: 'E0001', message: 'cannot open', notes: [{ message: 'n' }] },
    ],
  };
  assert.ok(isError(document));
  const [first, second] = messagesOf(document);
  assert.deepEqual(first?.place, { file: '/m.e', line: 3, column: 4 });
  assert.equal(first?.help, 'h');
  assert.equal(second?.place, undefined);
  assert.deepEqual(second?.notes, ['n']);
  assert.deepEqual(messagesOf({ status: 'ok' }), []);
});

test('traces with an error in the model check still are an answer', () => {
  assert.ok(!isError({ status: 'error', list: [] }));
});

test('explanations of three kinds', () => {
  const none = explanationOf({ status: 'ok', satisfiable: true, sets: [] });
  assert.ok(none.kind === 'contradictions' && none.sets.length === 0 && none.isComplete);
  const axiom = { file: 'm.e', line: 2, what: 'axiom', text: 'P().' };
  const sets = explanationOf({
    satisfiable: false,
    complete: false,
    cause_words: 'why',
    sets: [{ axioms: [{ ...axiom, column: 5, instances: ['i'] }], words: 'w' }],
    differences: [{ fluent: 'F()', timepoint: 1, predicted: true, observed: false, role: 'first' }],
  });
  assert.ok(sets.kind === 'contradictions');
  assert.deepEqual(sets.sets[0]?.axioms[0], {
    place: { file: 'm.e', line: 2, column: 5 },
    what: 'axiom',
    text: 'P().',
    instances: ['i'],
  });
  assert.deepEqual(sets.differences, [{ fluent: 'F()', timepoint: 1, predicted: true, observed: false }]);
  const steps = explanationOf({ trace: 2, fact: 'F', steps: [{ fact: 'F', why: 'effect', axiom, premises: ['E'] }] });
  assert.ok(steps.kind === 'reasons');
  assert.equal(steps.steps[0]?.axiom?.place.column, 1);
});

test('results of runs', () => {
  const result = runResultOf({
    verdict: 'discrepancy',
    simulations: 4,
    discrepancies: [{ cause: { text: 'a' } }, { cause: { text: 'a' } }, { cause: { text: 'b' } }],
  });
  assert.deepEqual(result, { verdict: 'discrepancy', simulations: 4, causes: ['a', 'b'] });
});
