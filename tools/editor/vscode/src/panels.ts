// The side panel: one for traces, one for explanations, one for reports, each used again.

import { randomBytes } from 'node:crypto';
import * as vscode from 'vscode';

import { hasStrictPolicy, openPlaceCommand } from './pages';
import { ProgramError } from './program';

export class Panels {
  private readonly open = new Map<string, vscode.WebviewPanel>();

  /** Shows a page of ours. `make` gets the nonce of its style. No script runs in it. */
  show(kind: 'traces' | 'explanation', title: string, make: (nonce: string) => string): void {
    const panel = this.panel(kind, title, {
      enableScripts: false,
      enableForms: false,
      enableCommandUris: [openPlaceCommand],
      localResourceRoots: [],
    });
    panel.webview.html = make(randomBytes(18).toString('base64'));
  }

  /** Shows a page that `parallax report` wrote. Its scripts are those that its policy names. */
  showReport(title: string, html: string): void {
    if (!hasStrictPolicy(html)) {
      throw new ProgramError('The page has no strict policy and is not shown. Open it in a browser.');
    }
    const panel = this.panel('report', title, {
      enableScripts: true,
      enableForms: false,
      localResourceRoots: [],
    });
    panel.webview.html = html;
  }

  private panel(kind: string, title: string, options: vscode.WebviewOptions): vscode.WebviewPanel {
    const known = this.open.get(kind);
    if (known !== undefined) {
      known.title = title;
      known.reveal(undefined, true);
      return known;
    }
    const panel = vscode.window.createWebviewPanel(
      `parallax.${kind}`,
      title,
      { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true },
      options,
    );
    panel.onDidDispose(() => this.open.delete(kind));
    this.open.set(kind, panel);
    return panel;
  }

  dispose(): void {
    for (const panel of [...this.open.values()]) panel.dispose();
  }
}

/** Opens a place that a link of a page names: [file, line, column], the numbers from 1. */
export async function openPlace(file: unknown, line: unknown, column: unknown): Promise<void> {
  if (typeof file !== 'string' || typeof line !== 'number' || typeof column !== 'number') return;
  const at = new vscode.Position(Math.max(0, line - 1), Math.max(0, column - 1));
  await vscode.window.showTextDocument(vscode.Uri.file(file), {
    viewColumn: vscode.ViewColumn.One,
    selection: new vscode.Range(at, at),
  });
}
