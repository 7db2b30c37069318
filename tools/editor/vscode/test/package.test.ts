// What is in the package: the files of a list, and a bundle that needs the editor alone.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import Module from 'node:module';
import { join } from 'node:path';
import { test } from 'node:test';
import { inflateRawSync } from 'node:zlib';

const root = join(__dirname, '../..');

/** The files of a ZIP archive: its central directory leads to each (APPNOTE 4.3). */
function unzipped(archive: Buffer): Map<string, Buffer> {
  const end = archive.lastIndexOf(Buffer.from('PK\x05\x06', 'latin1'));
  assert.ok(end >= 0, 'an archive has an end record');
  const files = new Map<string, Buffer>();
  let at = archive.readUInt32LE(end + 16);
  for (let left = archive.readUInt16LE(end + 10); left > 0; left -= 1) {
    assert.equal(archive.readUInt32LE(at), 0x02014b50);
    const method = archive.readUInt16LE(at + 10);
    const size = archive.readUInt32LE(at + 20);
    const [name, extra, comment] = [28, 30, 32].map((offset) => archive.readUInt16LE(at + offset)) as [number, number, number];
    const local = archive.readUInt32LE(at + 42);
    const begin = local + 30 + archive.readUInt16LE(local + 26) + archive.readUInt16LE(local + 28);
    const packed = archive.subarray(begin, begin + size);
    files.set(archive.toString('utf8', at + 46, at + 46 + name), method === 0 ? packed : inflateRawSync(packed));
    at += 46 + name + extra + comment;
  }
  return files;
}

const files = unzipped(readFileSync(join(root, 'parallax.vsix')));
const textOf = (name: string): string => files.get(`extension/${name}`)?.toString('utf8') ?? '';

test('the package holds these files and no others', () => {
  const schemas = ['gate', 'ledger', 'quarantine', 'scenario', 'suite', 'world'].map((name) => `schemas/${name}.yaml.json`);
  const own = [
    'LICENSE.txt',
    'dist/NOTICES.txt',
    'dist/extension.js',
    'language_configuration.json',
    'media/parallax.svg',
    'package.json',
    'readme.md',
    ...schemas,
    'syntaxes/dec.tmLanguage.json',
  ];
  const wanted = ['[Content_Types].xml', 'extension.vsixmanifest', ...own.map((name) => `extension/${name}`)];
  assert.deepEqual([...files.keys()].sort(), wanted.sort());
});

test('package.json has a version and exact dependencies', () => {
  const manifest = JSON.parse(textOf('package.json'));
  assert.match(manifest.version, /^[0-9]+\.[0-9]+\.[0-9]+$/);
  assert.notEqual(manifest.version, '0.0.0');
  for (const version of Object.values({ ...manifest.dependencies, ...manifest.devDependencies })) {
    assert.match(String(version), /^\d+\.\d+\.\d+$/);
  }
});

test('the bundle needs the editor and Node.js alone, and begins', () => {
  const required = [...textOf('dist/extension.js').matchAll(/\brequire\("([^"]+)"\)/g)].map((found) => found[1] ?? '');
  const outside = required.filter((name) => !Module.builtinModules.includes(name.replace(/^node:/, '')));
  assert.deepEqual([...new Set(outside)], ['vscode']);

  // Anything that the editor has may be a class that the bundle derives from.
  const anything: object = new Proxy(class {}, {
    get: (target, name) => (name === 'prototype' ? target.prototype : anything),
  });
  const loader = Module as unknown as { _load: (name: string, ...rest: unknown[]) => unknown };
  const load = loader._load;
  loader._load = (name, ...rest) => (name === 'vscode' ? anything : load(name, ...rest));
  try {
    const extension = require(join(root, 'dist/extension.js'));
    assert.equal(typeof extension.activate, 'function');
    assert.equal(typeof extension.deactivate, 'function');
  } finally {
    loader._load = load;
  }
});

test('licences of what is bundled are packed', () => {
  assert.match(textOf('dist/NOTICES.txt'), /^vscode-languageclient 9\.0\.1 \(MIT\)$/m);
  assert.match(textOf('LICENSE.txt'), /The parallax authors/);
});
