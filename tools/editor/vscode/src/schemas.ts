// JSON Schemas for the YAML extension, where it is installed. They are packed with this extension.

import { readFileSync } from 'node:fs';
import * as vscode from 'vscode';

import { schemaOf } from './yaml_kinds';

const yamlExtension = 'redhat.vscode-yaml';
const scheme = 'parallax-schema';

/** The part of the YAML extension's interface that is used. */
interface YamlInterface {
  registerContributor(
    name: string,
    schemaForFile: (file: string) => string | undefined,
    contentOfSchema: (schema: string) => string | undefined,
  ): boolean;
}

function hasContributors(exported: unknown): exported is YamlInterface {
  return typeof exported === 'object' && exported !== null && 'registerContributor' in exported;
}

/** False if the YAML extension is not installed. */
export async function contributeSchemas(extension: vscode.Uri): Promise<boolean> {
  const exported: unknown = await vscode.extensions.getExtension(yamlExtension)?.activate();
  if (!hasContributors(exported)) return false;
  return exported.registerContributor(
    scheme,
    (file) => {
      const document = vscode.workspace.textDocuments.find((one) => one.uri.toString() === file);
      const name = document === undefined ? undefined : schemaOf(document.getText());
      return name === undefined ? undefined : `${scheme}://schemas/${name}.json`;
    },
    (schema) => {
      const name = /^parallax-schema:\/\/schemas\/([a-z]+\.yaml)\.json$/.exec(schema)?.[1];
      if (name === undefined) return undefined;
      return readFileSync(vscode.Uri.joinPath(extension, 'schemas', `${name}.json`).fsPath, 'utf8');
    },
  );
}
