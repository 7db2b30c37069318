import assert from 'node:assert/strict';
import { chmodSync, mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';

import { ProgramError, documentOf, programOf, run } from '../src/program';

const folder = mkdtempSync(join(tmpdir(), 'parallax-editor-'));

/** A program in JavaScript that stands in for parallax. */
function standIn(name: string, text: string): string {
  const path = join(folder, name);
  writeFileSync(path, `#!${process.execPath}\n${text}\n`);
  chmodSync(path, 0o755);
  return path;
}

test('the setting is a name, an absolute path, or a path below the folder', () => {
  assert.equal(programOf('parallax', '/w'), 'parallax');
  assert.equal(programOf(' ', '/w'), 'parallax');
  assert.equal(programOf('/opt/p', '/w'), '/opt/p');
  assert.equal(programOf('build/release/parallax', '/w'), '/w/build/release/parallax');
});

test('words reach the program as they are, without a shell', async () => {
  const program = standIn('echo', 'console.log(JSON.stringify({ status: "ok", words: process.argv.slice(2) }))');
  const words = ['$(touch x)', 'a b', "'; rm", '*', '--why=a & b'];
  const answer = await run({ program, words, folder });
  assert.deepEqual(answer.document['words'], words);
  assert.equal(answer.code, 0);
});

test('the exit code, remarks and a closed standard input', async () => {
  const program = standIn(
    'code',
    `process.stdin.on('data', () => {}).on('end', () => {
       console.error('a remark'); console.log('{"status":"ok"}'); process.exitCode = 1; });`,
  );
  const answer = await run({ program, words: [], folder });
  assert.equal(answer.code, 1);
  assert.equal(answer.remarks, 'a remark\n');
});

test('a program that is not there is named, with the setting', async () => {
  await assert.rejects(run({ program: join(folder, 'none'), words: [], folder }), (error: Error) => {
    assert.ok(error instanceof ProgramError);
    assert.match(error.message, /none was not found.*parallax\.path/);
    return true;
  });
});

test('a program that prints no document', async () => {
  const program = standIn('text', 'console.error("it broke")');
  await assert.rejects(run({ program, words: [], folder }), /^Error: it broke$/);
  assert.throws(() => documentOf('[1]', ''), ProgramError);
  assert.throws(() => documentOf('', ''), /printed nothing/);
  assert.throws(() => documentOf('x', 'y'.repeat(5000)), (error: Error) => error.message.length < 2100);
});

test('cancelling interrupts the program, which may still answer', async () => {
  const program = standIn(
    'slow',
    `process.on('SIGINT', () => { console.log('{"status":"ok","interrupted":true}'); process.exit(4); });
     setInterval(() => {}, 1000); console.error('ready');`,
  );
  let interrupt: () => void = () => {};
  const answer = run({ program, words: [], folder }, (stop) => {
    interrupt = stop;
  });
  // Node sets the handler within this time; before it, the signal would end the process.
  await new Promise((resolve) => setTimeout(resolve, 500));
  interrupt();
  assert.equal((await answer).document['interrupted'], true);
});
