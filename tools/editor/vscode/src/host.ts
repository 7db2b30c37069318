// All that the extension starts goes through here: the one gate for trust, and the settings.

import * as vscode from 'vscode';

import { withoutLinks } from './pages';
import { type Answer, ProgramError, programOf, run } from './program';
import type { Permission } from './words';

/** The folder of the workspace that a file belongs to, or else that of the file. */
export function folderOf(file: vscode.Uri): string {
  const workspace = vscode.workspace.getWorkspaceFolder(file);
  return (workspace?.uri ?? vscode.Uri.joinPath(file, '..')).fsPath;
}

export class Host {
  readonly log = vscode.window.createOutputChannel('Parallax', { log: true });

  /** The program as the settings of this folder name it. Throws where nothing may be started. */
  program(folder: string): string {
    if (!vscode.workspace.isTrusted) {
      throw new ProgramError('This workspace is not trusted, so parallax is not started.');
    }
    const settings = vscode.workspace.getConfiguration('parallax', vscode.Uri.file(folder));
    return programOf(settings.get('path', 'parallax'), folder);
  }

  permission(): Permission {
    return { allowCommands: vscode.workspace.getConfiguration('parallax').get('allowCommands', false) };
  }

  traceLimit(file: vscode.Uri): number {
    return vscode.workspace.getConfiguration('parallax', file).get('traceLimit', 20);
  }

  /** Runs the program in a folder to its end; a cancelled token interrupts it. */
  async ask(words: readonly string[], folder: string, token: vscode.CancellationToken): Promise<Answer> {
    const program = this.program(folder);
    this.log.info([program, ...words].join(' '));
    const answer = await run({ program, words, folder }, (stop) => {
      if (token.isCancellationRequested) stop();
      token.onCancellationRequested(stop);
    });
    const remarks = answer.remarks.trim();
    if (remarks !== '') this.log.info(remarks);
    return answer;
  }

  /** Asks with a bar in the window that can be cancelled. */
  async askWithProgress(title: string, words: readonly string[], folder: string): Promise<Answer> {
    return vscode.window.withProgress(
      { location: vscode.ProgressLocation.Notification, title, cancellable: true },
      (_progress, token) => this.ask(words, folder, token),
    );
  }

  /** Tells of an error where the user looks, and writes all of it into the log. */
  tell(error: unknown): void {
    const text = error instanceof Error ? error.message : String(error);
    this.log.error(text);
    const first = withoutLinks(text.split('\n', 1)[0] ?? text);
    void vscode.window.showErrorMessage(first, 'Show Log').then((chosen) => {
      if (chosen !== undefined) this.log.show(true);
    });
  }

  dispose(): void {
    this.log.dispose();
  }
}
