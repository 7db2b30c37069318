// What the extension registers and starts, with a stand-in for the editor and for the program.

import { context, editor } from './fake_vscode';

import assert from 'node:assert/strict';
import { chmodSync, existsSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';

import { activate, deactivate } from '../src/extension';

const root = join(__dirname, '../..');
const manifest = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));
const folder = mkdtempSync(join(tmpdir(), 'parallax-editor-'));
const started = join(folder, 'started');
const program = join(folder, 'parallax');

// Notes its words, and answers as `traces` does.
writeFileSync(
  program,
  `#!${process.execPath}
require('fs').appendFileSync(${JSON.stringify(started)}, JSON.stringify(process.argv.slice(2)) + '\\n');
console.log(JSON.stringify({ status: 'ok', traces: 0, complete: true, list: [], cases: [], verdict: 'inconclusive',
  simulations: 0, discrepancies: [{ cause: { text: 'see [this](command:x)' } }] }));
`,
);
chmodSync(program, 0o755);

const lines = (): string[][] =>
  existsSync(started) ? readFileSync(started, 'utf8').trim().split('\n').map((line) => JSON.parse(line)) : [];

async function command(name: string, ...words: unknown[]): Promise<void> {
  await editor.commands.get(name)?.(...words);
}

test('nothing is started in a workspace that is not trusted', async () => {
  editor.folder = folder;
  editor.isTrusted = false;
  editor.settings.set('path', program);
  editor.settings.set('allowCommands', true);
  editor.activeFile = join(folder, 'm.e');
  editor.input = 'HoldsAt(F(),1)';
  await activate(context(join(folder, 'storage'), root) as never);
  await command('parallax.traces');
  await command('parallax.explain');
  await command('parallax.restartServer');
  editor.activeFile = join(folder, 's.yaml');
  await command('parallax.run');
  assert.deepEqual(lines(), []);
  assert.equal(editor.servers.length, 0);
  assert.equal(editor.tests, undefined);
  assert.deepEqual(await editor.trees.get('parallax.runs')?.getChildren(), []);
  assert.match(editor.messages.join(), /not trusted/);
});

test('trust starts the server and the tests, and a changed path restarts the server', async () => {
  editor.isTrusted = true;
  editor.trusted.fire();
  await command('parallax.restartServer');
  assert.deepEqual(
    editor.servers.map((server) => [server.command, server.words, server.folder, server.isRunning]),
    [
      [program, ['lsp'], folder, false],
      [program, ['lsp'], folder, true],
    ],
  );
  assert.notEqual(editor.tests, undefined);
  editor.configured.fire({ affectsConfiguration: (name) => name === 'parallax.path' });
  await command('parallax.restartServer');
  assert.equal(editor.servers.filter((server) => server.isRunning).length, 1);
});

test('commands of scenarios are forbidden unless the setting permits them', async () => {
  editor.settings.set('allowCommands', false);
  editor.activeFile = join(folder, 's.yaml');
  await command('parallax.run');
  editor.settings.set('allowCommands', true);
  await command('parallax.run');
  const runs = lines().filter((words) => words[0] === 'run');
  assert.deepEqual(runs.map((words) => words.at(-1)), ['--no-commands', '--allow-commands']);
  assert.equal(manifest.contributes.configuration.properties['parallax.allowCommands'].scope, 'machine');
  assert.deepEqual(manifest.capabilities.untrustedWorkspaces.restrictedConfigurations.slice(0, 2), [
    'parallax.path',
    'parallax.allowCommands',
  ]);
});

test('what the program says makes no link in a notification', () => {
  const told = editor.messages.filter((message) => message.includes('see [this]'));
  assert.ok(told.length > 0 && told.every((message) => message.endsWith('see [this] (command:x)')));
});

test('a file of another kind, and a program that is not there', async () => {
  editor.messages.length = 0;
  editor.activeFile = join(folder, 'notes.txt');
  await command('parallax.traces');
  assert.match(editor.messages[0] ?? '', /Open a file that ends in \.e/);
  editor.settings.set('path', join(folder, 'none'));
  editor.activeFile = join(folder, 'm.e');
  await command('parallax.traces');
  assert.match(editor.messages[1] ?? '', /none was not found/);
});

test('package.json names the commands that are registered, and the other way round', () => {
  const named = manifest.contributes.commands.map((one: { command: string }) => one.command).sort();
  assert.deepEqual([...editor.commands.keys()].sort(), named);
  const used = Object.values(manifest.contributes.menus).flat() as { command: string }[];
  for (const one of used) assert.ok(named.includes(one.command), one.command);
});

test('files that package.json names are there', () => {
  const { contributes } = manifest;
  const files = [
    ...contributes.grammars.map((one: { path: string }) => one.path),
    ...contributes.languages.map((one: { configuration: string }) => one.configuration),
    ...contributes.viewsContainers.activitybar.map((one: { icon: string }) => one.icon),
    manifest.main,
  ];
  for (const file of files) assert.ok(existsSync(join(root, file)), file);
});

test('schemas are contributed to the YAML extension', async () => {
  const taken: ((name: string) => string | undefined)[] = [];
  editor.yamlExtension = {
    registerContributor: (_name: string, ...functions: ((name: string) => string | undefined)[]) => {
      taken.push(...functions);
      return true;
    },
  };
  await activate(context(join(folder, 'storage'), root) as never);
  const [schemaForFile, contentOfSchema] = taken;
  assert.equal(schemaForFile?.('file:///unknown.yaml'), undefined);
  assert.match(contentOfSchema?.('parallax-schema://schemas/suite.yaml.json') ?? '', /"cases"/);
  for (const bad of ['parallax-schema://schemas/../package.json', 'file:///etc/passwd', 'parallax-schema://schemas/x']) {
    assert.equal(contentOfSchema?.(bad), undefined);
  }
});

test('the server ends with the editor', async () => {
  await deactivate();
  assert.equal(editor.servers.at(-1)?.isRunning, false);
});
