// What happens when the extension begins: in a trusted workspace everything, else nothing is
// started until the user trusts it.

import * as vscode from 'vscode';

import { Client } from './client';
import { Commands } from './commands';
import { Host } from './host';
import { Panels } from './panels';
import { RunsView } from './runs_view';
import { contributeSchemas } from './schemas';
import { TestExplorer } from './test_explorer';

let client: Client | undefined;

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const host = new Host();
  const panels = new Panels();
  const runs = new RunsView();
  const storage = context.storageUri ?? context.globalStorageUri;
  const server = new Client(host);
  client = server;
  context.subscriptions.push(
    host,
    panels,
    vscode.window.registerTreeDataProvider('parallax.runs', runs),
    ...new Commands(host, panels, runs, storage).register(),
    vscode.commands.registerCommand('parallax.restartServer', () => server.restart()),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration('parallax.path')) void server.restart();
    }),
  );
  const begin = (): void => {
    context.subscriptions.push(new TestExplorer(host, storage));
    runs.refresh();
    void server.restart();
  };
  if (vscode.workspace.isTrusted) {
    begin();
  } else {
    context.subscriptions.push(vscode.workspace.onDidGrantWorkspaceTrust(begin));
  }
  // Schemas are data of this extension: nothing is started for them.
  await contributeSchemas(context.extensionUri).catch((error: unknown) => host.log.error(String(error)));
}

export async function deactivate(): Promise<void> {
  await client?.stop();
}
