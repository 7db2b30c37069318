import assert from 'node:assert/strict';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import type { Traces } from '../src/documents';
import { changes, escaped, explanationPage, hasStrictPolicy, messagesPage, tracesPage } from '../src/pages';

const evil = `<script>alert(1)</script><img src=x onerror="a">'&`;
const named = '`<b>`';

function point(time: number, holds: string[], happens: string[] = [], released: string[] = []) {
  return { time, holds, happens, released };
}

const traces: Traces = {
  kind: 'traces',
  isComplete: true,
  list: [
    {
      number: 1,
      predicates: ['Ab(James,1)'],
      ended: 'done',
      timepoints: [
        point(0, ['Heads()'], ['Toss()']),
        point(1, ['Spinning()'], [], ['Heads()']),
        point(2, ['Heads()', 'Spinning()'], ['Catch()'], ['Heads()']),
        point(3, ['Heads()']),
      ],
    },
    { number: 2, predicates: [], ended: '', timepoints: [point(0, [evil], [evil])] },
  ],
};

/** Every element and attribute of the page is one that the templates write. */
function checkMarkup(html: string): void {
  const known = 'html head meta title style body h1 h2 p span table thead tbody tr th td details summary ol li a code br ins del';
  const names = new Set(known.split(' '));
  for (const [, name = ''] of html.matchAll(/<\/?([a-zA-Z][^\s>/]*)/g)) assert.ok(names.has(name), name);
  for (const [, name = ''] of html.matchAll(/\s([a-z-]+)=["']/g)) {
    assert.match(name, /^(lang|charset|http-equiv|content|name|nonce|class|scope|data-head|href)$/);
  }
}

test('the policy admits one style by its nonce, and nothing else', () => {
  const html = tracesPage('lamp.e', traces, 'abc');
  assert.match(html, /content="default-src 'none'; style-src 'nonce-abc'; base-uri 'none'; form-action 'none'"/);
  assert.equal(html.match(/<style nonce="abc">/g)?.length, 1);
  assert.ok(!/<script|<[^>]*\s(?:style|on[a-z]+)=|https?:|url\(|@import/.test(html));
  checkMarkup(html);
});

test('texts of models are texts in a page', () => {
  assert.equal(escaped(evil), '&lt;script&gt;alert(1)&lt;/script&gt;&lt;img src=x onerror=&quot;a&quot;&gt;&#39;&amp;');
  const axiom = { place: { file: `/${evil}`, line: 1, column: 1 }, what: evil, text: evil, instances: [evil] };
  const pages = [
    tracesPage(evil, traces, 'n'),
    explanationPage(
      evil,
      {
        kind: 'contradictions',
        isComplete: false,
        cause: evil,
        sets: [{ axioms: [axiom], words: evil }],
        differences: [{ fluent: evil, timepoint: 1, predicted: true, observed: false }],
      },
      '/w',
      'n',
    ),
    explanationPage(
      evil,
      {
        kind: 'reasons',
        trace: 1,
        fact: evil,
        steps: [{ fact: evil, why: evil, axiom, premises: [evil], absent: [evil] }],
      },
      '/w',
      'n',
    ),
    messagesPage(
      evil,
      [{ severity: evil, code: evil, message: evil, help: evil, notes: [evil], place: axiom.place }],
      '/w',
      'n',
    ),
  ];
  for (const html of pages) {
    checkMarkup(html);
    assert.ok(!html.includes('<img') && !html.includes('<script'));
  }
});

test('names between backticks are code, and still texts', () => {
  const message = { severity: 'error', code: 'E2101', message: `no fluent ${named}`, help: '', notes: [], place: undefined };
  assert.ok(messagesPage('m.e', [message], '/w', 'n').includes('no fluent <code>&lt;b&gt;</code></li>'));
});

test('a table has a row for each timepoint, with what changes', () => {
  assert.deepEqual(changes(point(0, ['A', 'B']), point(1, ['B', 'C'])), { begins: ['C'], ends: ['A'] });
  assert.deepEqual(changes(undefined, point(0, ['A'])), { begins: [], ends: [] });
  const html = tracesPage('coin.e', traces, 'n');
  assert.equal(html.match(/<tr><th scope="row">/g)?.length, 5);
  assert.ok(html.includes('+Spinning()') && html.includes('−Heads()'));
  assert.ok(html.includes('2 traces, and no others.'));
  assert.ok(tracesPage('coin.e', { ...traces, isComplete: false }, 'n').includes('The first 2 traces.'));
  assert.ok(tracesPage('coin.e', { ...traces, list: [] }, 'n').includes('There is no trace'));
});

test('links call one command, with a place and nothing else', () => {
  const html = messagesPage(
    'm.e',
    [{ severity: 'error', code: 'E2101', message: 'no', help: '', notes: [], place: { file: 'a b.e', line: 3, column: 4 } }],
    '/w',
    'n',
  );
  const [, command, query = ''] = /<a href="command:([a-zA-Z.]+)\?([^"]*)">a b\.e:3</.exec(html) ?? [];
  assert.equal(command, 'parallax.openPlace');
  assert.deepEqual(JSON.parse(decodeURIComponent(query)), ['/w/a b.e', 3, 4]);
});

test('only pages with a closed policy of hashes are shown', () => {
  const page = (policy: string, before = ''): string =>
    `<!DOCTYPE html><html><head>${before}<meta http-equiv="Content-Security-Policy" content="${policy}"></head>`;
  const hash = `'sha256-${'A'.repeat(43)}='`;
  assert.ok(hasStrictPolicy(page(`default-src 'none'; style-src ${hash}; script-src ${hash} ${hash}; base-uri 'none'`)));
  assert.ok(!hasStrictPolicy('<html></html>'));
  assert.ok(!hasStrictPolicy(page(`script-src ${hash}`)));
  for (const open of ["'unsafe-inline'", 'https://example.org', '*', 'data:', "'self'"]) {
    assert.ok(!hasStrictPolicy(page(`default-src 'none'; script-src ${open}`)), open);
  }
  assert.ok(!hasStrictPolicy(page("default-src 'none'", '<script>1</script>')));
});

test('pages can be looked at: PARALLAX_PAGES names a folder for them', { skip: !process.env['PARALLAX_PAGES'] }, () => {
  const folder = process.env['PARALLAX_PAGES'] ?? '';
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, 'traces.html'), tracesPage('coin.e', { ...traces, list: traces.list.slice(0, 1) }, 'n'));
});
