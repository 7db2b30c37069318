// A conversation of an editor with `parallax lsp`, through the client's own reader and writer of
// messages. lsp_conversation.json has it: of what the server says, the parts that must be there.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

import { StreamMessageReader, StreamMessageWriter, createMessageConnection } from 'vscode-languageserver-protocol/node';

import { selector } from '../src/selector';
import { serverWords } from '../src/words';

interface Step {
  request?: string;
  notify?: string;
  await?: string;
  params: unknown;
  result?: unknown;
}

const program = process.env['PARALLAX_PROGRAM'] ?? '';
const skip = program === '' ? 'SKIPPED: PARALLAX_PROGRAM names no program' : false;

/**
 * Is everything that is wanted there? Lists have the same length, objects may have more keys.
 * `{"contains": [...]}` are parts of a text, `{"includes": [...]}` items of a list in any order.
 */
function contains(wanted: unknown, said: unknown, place: string): void {
  if (Array.isArray(wanted)) {
    assert.ok(Array.isArray(said) && said.length === wanted.length, `${place}: ${JSON.stringify(said)}`);
    wanted.forEach((item, at) => contains(item, said[at], `${place}[${at}]`));
  } else if (typeof wanted === 'object' && wanted !== null) {
    if ('contains' in wanted && typeof said === 'string') {
      for (const part of wanted.contains as string[]) assert.ok(said.includes(part), `${place}: ${said}`);
      return;
    }
    if ('includes' in wanted && Array.isArray(said)) {
      for (const item of wanted.includes as unknown[]) assert.ok(said.some((one) => fits(item, one)), place);
      return;
    }
    assert.ok(typeof said === 'object' && said !== null, `${place}: ${JSON.stringify(said)}`);
    for (const [key, value] of Object.entries(wanted)) {
      contains(value, (said as Record<string, unknown>)[key], `${place}.${key}`);
    }
  } else {
    assert.deepEqual(said, wanted, place);
  }
}

function fits(wanted: unknown, said: unknown): boolean {
  try {
    contains(wanted, said, '');
    return true;
  } catch {
    return false;
  }
}

function within<T>(promise: Promise<T>, what: string): Promise<T> {
  let timer: NodeJS.Timeout;
  const late = new Promise<never>((_resolve, reject) => {
    timer = setTimeout(() => reject(new Error(`${what} did not come in 20 s`)), 20_000);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

test('the conversation of an editor with the server', { skip }, async () => {
  const folder = mkdtempSync(join(tmpdir(), 'parallax-editor-'));
  const file = join(__dirname, '../../test/lsp_conversation.json');
  const text = readFileSync(file, 'utf8').replaceAll('${folder}', pathToFileURL(folder).href);
  const steps: Step[] = JSON.parse(text);
  const server = spawn(program, serverWords(), { cwd: folder, stdio: ['pipe', 'pipe', 'inherit'] });
  const ended = new Promise((resolve) => server.once('exit', resolve));
  const connection = createMessageConnection(new StreamMessageReader(server.stdout), new StreamMessageWriter(server.stdin));
  const told: { method: string; params: unknown }[] = [];
  let arrived: () => void = () => {};
  connection.onNotification((method, params) => {
    told.push({ method, params });
    arrived();
  });
  connection.listen();
  try {
    for (const step of steps) {
      const name = step.request ?? step.notify ?? step.await ?? '';
      if (step.request !== undefined) {
        contains(step.result, await within(connection.sendRequest(name, step.params), name), name);
      } else if (step.notify !== undefined) {
        await connection.sendNotification(name, step.params);
      } else {
        while (!told.some((one) => one.method === name)) {
          await within(new Promise<void>((resolve) => (arrived = resolve)), name);
        }
        const [first] = told.splice(told.findIndex((one) => one.method === name), 1);
        contains(step.params, first?.params, name);
      }
    }
    assert.equal(await within(ended, 'the end'), 0);
  } finally {
    connection.dispose();
    server.kill('SIGKILL');
  }
});

test('the server is told of models, binding tables, scenarios and plans', () => {
  assert.deepEqual(selector.map((one) => one.language ?? one.pattern), ['dec', 'dec-bind', 'yaml', '**/*.lisp']);
  assert.ok(selector.every((one) => one.scheme === 'file'));
});
