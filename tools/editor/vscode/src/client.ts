// The language client: `parallax lsp` for each window, restarted when its path changes.

import * as vscode from 'vscode';
import { LanguageClient, type LanguageClientOptions, type ServerOptions } from 'vscode-languageclient/node';

import { Host } from './host';
import { selector, watched } from './selector';
import { serverWords } from './words';

export class Client {
  private client: LanguageClient | undefined;
  private readonly watcher = vscode.workspace.createFileSystemWatcher(watched);
  /** Starts and stops come one after the other. */
  private last: Promise<void> = Promise.resolve();

  constructor(private readonly host: Host) {}

  restart(): Promise<void> {
    return this.queue(async () => {
      await this.end();
      await this.begin();
    });
  }

  stop(): Promise<void> {
    return this.queue(async () => {
      await this.end();
      this.watcher.dispose();
    });
  }

  private queue(act: () => Promise<void>): Promise<void> {
    this.last = this.last.then(act).catch((error: unknown) => this.host.tell(error));
    return this.last;
  }

  private async begin(): Promise<void> {
    if (!vscode.workspace.isTrusted) return;
    const folder = vscode.workspace.workspaceFolders?.[0]?.uri.fsPath ?? process.cwd();
    const server: ServerOptions = {
      command: this.host.program(folder),
      args: serverWords(),
      options: { cwd: folder, shell: false },
    };
    const options: LanguageClientOptions = {
      documentSelector: selector,
      outputChannel: this.host.log,
      synchronize: { fileEvents: this.watcher },
    };
    const client = new LanguageClient('parallax', 'Parallax', server, options);
    this.client = client;
    await client.start();
  }

  private async end(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    if (client !== undefined) await client.dispose();
  }
}
