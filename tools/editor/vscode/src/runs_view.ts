// The view of runs: folders with a journal, the newest first, each with its verdict.

import { readFile, stat } from 'node:fs/promises';
import { basename, dirname, join } from 'node:path';
import * as vscode from 'vscode';

import { outermost, verdictOf } from './runs';

const mostRuns = 500;

interface FoundRun {
  folder: string;
  changedMs: number;
  verdict: string;
}

export class RunsView implements vscode.TreeDataProvider<vscode.TreeItem> {
  private readonly changed = new vscode.EventEmitter<void>();
  readonly onDidChangeTreeData = this.changed.event;

  refresh(): void {
    this.changed.fire();
  }

  getTreeItem(item: vscode.TreeItem): vscode.TreeItem {
    return item;
  }

  async getChildren(parent?: vscode.TreeItem): Promise<vscode.TreeItem[]> {
    if (parent !== undefined || !vscode.workspace.isTrusted) return [];
    return (await this.find()).map((run) => {
      const item = new vscode.TreeItem(basename(run.folder));
      item.id = run.folder;
      item.resourceUri = vscode.Uri.file(run.folder);
      item.description = run.verdict;
      item.tooltip = vscode.workspace.asRelativePath(run.folder);
      item.iconPath = new vscode.ThemeIcon(iconOf(run.verdict));
      item.contextValue = 'run';
      item.command = { command: 'parallax.report', title: 'Show Report', arguments: [item.resourceUri] };
      return item;
    });
  }

  /** The run that a tree item or a command names; without one the user chooses. */
  async pick(target: unknown): Promise<vscode.Uri | undefined> {
    if (target instanceof vscode.Uri) return target;
    if (target instanceof vscode.TreeItem && target.resourceUri !== undefined) return target.resourceUri;
    const runs = await this.find();
    if (runs.length === 0) {
      void vscode.window.showInformationMessage('No folder of a run was found in this workspace.');
      return undefined;
    }
    const chosen = await vscode.window.showQuickPick(
      runs.map((run) => ({
        label: basename(run.folder),
        description: run.verdict,
        detail: vscode.workspace.asRelativePath(run.folder),
        folder: run.folder,
      })),
      { title: 'Which run?' },
    );
    return chosen === undefined ? undefined : vscode.Uri.file(chosen.folder);
  }

  private async find(): Promise<FoundRun[]> {
    const journals = await vscode.workspace.findFiles('**/journal.ndjson', '**/node_modules/**', mostRuns);
    const folders = outermost(journals.map((journal) => dirname(journal.fsPath)));
    const runs = await Promise.all(folders.map(look));
    return runs.sort((a, b) => b.changedMs - a.changedMs || a.folder.localeCompare(b.folder));
  }
}

async function look(folder: string): Promise<FoundRun> {
  const changedMs = await stat(join(folder, 'journal.ndjson')).then((found) => found.mtimeMs, () => 0);
  const report = await readFile(join(folder, 'report.json'), 'utf8').catch(() => '');
  return { folder, changedMs, verdict: verdictOf(report) };
}

function iconOf(verdict: string): string {
  if (verdict === 'discrepancy') return 'error';
  return verdict === 'no-discrepancy' ? 'pass' : 'circle-outline';
}
