// Lays out the folder in which the extension is compiled: its own files, and what the repository
// has elsewhere, so that neither is kept twice. `node stage.mjs REPOSITORY FOLDER`.

import { cpSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [repository, folder] = process.argv.slice(2);
const own = join(repository, 'tools/editor/vscode');

for (const name of ['src', 'test', 'media', 'tsconfig.json', '.vscodeignore', 'README.md', 'language_configuration.json']) {
  cpSync(join(own, name), join(folder, name), { recursive: true });
}
mkdirSync(join(folder, 'syntaxes'), { recursive: true });
cpSync(join(repository, 'tools/editor/dec.tmLanguage.json'), join(folder, 'syntaxes/dec.tmLanguage.json'));
cpSync(join(repository, 'LICENSE'), join(folder, 'LICENSE.txt'));

// The extension has the version of the program, which stands in one place.
const version = /^project\(parallax VERSION (\d+\.\d+\.\d+)/m.exec(readFileSync(join(repository, 'CMakeLists.txt'), 'utf8'))[1];
const manifest = JSON.parse(readFileSync(join(own, 'package.json'), 'utf8'));
manifest.version = version;
writeFileSync(join(folder, 'package.json'), `${JSON.stringify(manifest, null, 2)}\n`);

// Schemas of YAML files, each with the definitions that it refers to, as `parallax schema` prints them.
const documents = join(repository, 'tools/schema/documents');
const read = (name) => JSON.parse(readFileSync(join(documents, `${name}.json`), 'utf8'));
const definitions = read('common');

function references(json, found) {
  if (typeof json !== 'object' || json === null) return found;
  const name = typeof json.$ref === 'string' ? json.$ref.slice('#/$defs/'.length) : undefined;
  if (name !== undefined && !found.has(name)) {
    found.add(name);
    references(definitions[name], found);
  }
  for (const part of Object.values(json)) references(part, found);
  return found;
}

mkdirSync(join(folder, 'schemas'), { recursive: true });
for (const name of ['gate.yaml', 'ledger.yaml', 'quarantine.yaml', 'scenario.yaml', 'suite.yaml', 'world.yaml']) {
  const schema = read(name);
  const used = [...references(schema, new Set())].sort();
  const whole = {
    $schema: 'https://json-schema.org/draft/2020-12/schema',
    $id: `urn:parallax:schema:${name}:${schema.version}`,
    ...schema,
    ...(used.length > 0 ? { $defs: Object.fromEntries(used.map((one) => [one, definitions[one]])) } : {}),
  };
  writeFileSync(join(folder, 'schemas', `${name}.json`), `${JSON.stringify(whole, null, 2)}\n`);
}
