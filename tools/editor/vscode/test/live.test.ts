// The extension with the real program, which PARALLAX_PROGRAM names.

import { context, editor, type TestItem } from './fake_vscode';

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';

import { activate } from '../src/extension';
import { schemaOf } from '../src/yaml_kinds';

const program = process.env['PARALLAX_PROGRAM'] ?? '';
const repository = process.env['PARALLAX_REPOSITORY'] ?? '';
const skip = program === '' ? 'SKIPPED: PARALLAX_PROGRAM names no program' : false;
const root = join(__dirname, '../..');
const folder = mkdtempSync(join(tmpdir(), 'parallax-editor-'));
const file = (name: string): string => join(folder, name);
const stop = { isCancellationRequested: false, onCancellationRequested: () => ({ dispose: () => {} }) };

writeFileSync(
  file('lamp.e'),
  `range time 0 2
sort lamp
lamp A
fluent On(lamp)
event Press(lamp)
[lamp,time] Initiates(Press(lamp),On(lamp),time).
[lamp] !HoldsAt(On(lamp),0).
Delta: Happens(Press(A),0).
completion Happens
`,
);
writeFileSync(file('dark.e'), 'load lamp.e\nHoldsAt(On(A),0).\n');
writeFileSync(file('wrong.e'), 'load lamp.e\nHoldsAt(Onn(A),0).\n');
writeFileSync(
  file('suite.yaml'),
  `cases:
  - id: one
    model: lamp.e
    expect: {traces: 1}
  - id: one_more
    model: lamp.e
    expect: {traces: 2}
  - id: wrong
    model: wrong.e
    expect: {traces: 1}
`,
);

async function command(name: string, activeFile: string, input = ''): Promise<string> {
  editor.activeFile = file(activeFile);
  editor.input = input;
  editor.messages.length = 0;
  await editor.commands.get(name)?.();
  return editor.messages.join('\n');
}

const shown = (kind: string): string => editor.panels.find((panel) => panel.kind === kind)?.webview.html ?? '';

/** For looking at: PARALLAX_PAGES names a folder. */
function keep(name: string, html: string): void {
  const pages = process.env['PARALLAX_PAGES'] ?? '';
  if (pages === '') return;
  mkdirSync(pages, { recursive: true });
  writeFileSync(join(pages, `${name}.html`), html);
}

test('the extension begins', { skip }, async () => {
  editor.folder = folder;
  editor.settings.set('path', program);
  await activate(context(file('.storage'), root) as never);
});

test('traces as a table', { skip }, async () => {
  assert.equal(await command('parallax.traces', 'lamp.e'), '');
  const html = shown('parallax.traces');
  assert.match(html, /1 trace, and no others/);
  assert.match(html, /\+On\(A\)/);
  assert.equal(html.match(/<tr><th scope="row">/g)?.length, 3);
  assert.deepEqual(editor.panels[0]?.options, {
    enableScripts: false,
    enableForms: false,
    enableCommandUris: ['parallax.openPlace'],
    localResourceRoots: [],
  });
});

test('explanations of facts and of contradictions', { skip }, async () => {
  await command('parallax.explain', 'lamp.e', 'HoldsAt(On(A),2)');
  keep('reasons', shown('parallax.explanation'));
  assert.match(shown('parallax.explanation'), /in trace 1.*effect.*lamp\.e:6.*inertia.*lamp\.e:4/s);
  await command('parallax.explain', 'dark.e');
  keep('contradictions', shown('parallax.explanation'));
  assert.match(shown('parallax.explanation'), /dark\.e:2.*HoldsAt\(On\(A\),0\)/s);
});

test('an error has a page with links to its places', { skip }, async () => {
  await command('parallax.traces', 'wrong.e');
  keep('messages', shown('parallax.traces'));
  assert.match(shown('parallax.traces'), /wrong\.e:2<\/a>: error\[E2101\]/);
});

test('cases are listed, run, and told of at their places', { skip }, async () => {
  await editor.tests?.refresh(stop);
  const suite = editor.tests?.items.find(file('suite.yaml'));
  assert.deepEqual(suite?.children.ids(), ['one', 'one_more', 'wrong'].map((id) => `${file('suite.yaml')}:${id}`));
  const outcomes = async (...include: TestItem[]) => {
    editor.outcomes.length = 0;
    await editor.tests?.run({ include }, stop);
    return editor.outcomes.map(({ id, ...rest }) => ({ id: id.slice(id.indexOf(':') + 1), ...rest }));
  };
  assert.ok(suite !== undefined);
  const one = suite.children.find(`${file('suite.yaml')}:one`);
  assert.ok(one !== undefined);
  // `--only` selects one_more as well, which nobody asked for.
  assert.deepEqual((await outcomes(one)).map((told) => [told.id, told.outcome]), [['one', 'passed']]);
  const all = await outcomes(suite);
  assert.deepEqual(
    all.map((told) => [told.id, told.outcome, told.file, told.line]),
    [
      ['one', 'passed', undefined, undefined],
      ['one_more', 'failed', file('suite.yaml'), 4],
      ['wrong', 'errored', file('wrong.e'), 1],
    ],
  );
  assert.match(all[1]?.text ?? '', /1 trace, expected 2 traces/);
  assert.ok(!existsSync(file('out')), 'results are kept in a folder of the editor');
});

test('a broken manifest is told of, and the earlier list stays', { skip }, async () => {
  writeFileSync(file('broken.yaml'), 'cases:\n  - id: a\n    expect: {traces: 1}\n');
  await editor.tests?.refresh(stop);
  const ids = editor.tests?.items.ids() ?? [];
  assert.ok(ids.includes(file('suite.yaml')));
  const problem = editor.tests?.items.find(`${folder}#0`);
  assert.equal(problem?.uri?.fsPath, file('broken.yaml'));
  assert.match(problem?.error ?? '', /E5106: the case lacks the key `model`/);
  writeFileSync(file('broken.yaml'), '{}\n');
});

test('a scenario is run, and its report shown', { skip: skip || repository === '' }, async () => {
  cpSync(join(repository, 'scenarios/two_regions'), file('two_regions'), { recursive: true });
  const told = await command('parallax.run', 'two_regions/edge.yaml');
  assert.match(told, /edge: discrepancy after \d+ simulations?: Place\(r1\): not BoxIn\(r1\)/);
  assert.match(shown('parallax.report'), /<meta name="generator" content="parallax report">/);
  const report = editor.panels.find((panel) => panel.kind === 'parallax.report');
  assert.deepEqual(report?.options.localResourceRoots, []);
  const runs = (await editor.trees.get('parallax.runs')?.getChildren()) ?? [];
  assert.deepEqual(runs.map((run) => [run.label, run.description]), [['edge', 'discrepancy']]);
  assert.deepEqual(readdirSync(file('out/edge')).includes('report.html'), false);
});

test('packed schemas are those of the program', { skip }, () => {
  for (const name of readdirSync(join(root, 'schemas'))) {
    const own = JSON.parse(readFileSync(join(root, 'schemas', name), 'utf8'));
    const printed = execFileSync(program, ['schema', name.replace(/\.json$/, '')], { encoding: 'utf8' });
    assert.deepEqual(own, JSON.parse(printed), name);
  }
});

test('every scenario and manifest of the repository is recognised', { skip: skip || repository === '' }, () => {
  const listed = execFileSync(program, ['suite', join(repository, 'scenarios'), '--collect-only', '--json'], {
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'ignore'],
  });
  const cases: { file: string; case: string }[] = JSON.parse(listed).cases;
  assert.ok(cases.length > 50);
  for (const one of cases) {
    const kind = one.case === one.file ? 'scenario.yaml' : 'suite.yaml';
    assert.equal(schemaOf(readFileSync(one.file, 'utf8')), kind, one.file);
  }
});
