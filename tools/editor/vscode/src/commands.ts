// The commands: each asks the program once and shows what it said.

import { createHash } from 'node:crypto';
import { existsSync } from 'node:fs';
import { mkdir, readFile } from 'node:fs/promises';
import { basename, dirname, join, parse } from 'node:path';
import * as vscode from 'vscode';

import { explanationOf, isError, messagesOf, runResultOf, tracesOf } from './documents';
import { Host, folderOf } from './host';
import { explanationPage, messagesPage, openPlaceCommand, tracesPage, withoutLinks } from './pages';
import { Panels, openPlace } from './panels';
import { RunsView } from './runs_view';
import { explainRunWords, explainWords, freeName, reportWords, runWords, traceWords } from './words';

/** A tree item, a file of the explorer, or nothing: then the file of the active editor. */
type Target = vscode.Uri | { resourceUri?: vscode.Uri } | undefined;

/** Files that the program reads; others are not saved. */
const isRead = /\.(e|bind|lisp|ya?ml)$/;

function uriOf(target: Target): vscode.Uri | undefined {
  if (target instanceof vscode.Uri) return target;
  return target?.resourceUri ?? vscode.window.activeTextEditor?.document.uri;
}

export class Commands {
  constructor(
    private readonly host: Host,
    private readonly panels: Panels,
    private readonly runs: RunsView,
    private readonly storage: vscode.Uri,
  ) {}

  register(): vscode.Disposable[] {
    const command = (name: string, act: (target: Target) => Promise<void>): vscode.Disposable =>
      vscode.commands.registerCommand(name, async (target: Target) => {
        try {
          await act(target);
        } catch (error) {
          this.host.tell(error);
        }
      });
    return [
      command('parallax.traces', (target) => this.traces(target)),
      command('parallax.explain', (target) => this.explain(target)),
      command('parallax.run', (target) => this.run(target)),
      command('parallax.report', (target) => this.report(target)),
      command('parallax.explainRun', (target) => this.explainRun(target)),
      command('parallax.refreshRuns', async () => this.runs.refresh()),
      vscode.commands.registerCommand(openPlaceCommand, openPlace),
    ];
  }

  /** The file that a command is about, saved, as the program reads it from the disk. */
  private async file(target: Target, endings: readonly string[]): Promise<vscode.Uri | undefined> {
    const uri = uriOf(target);
    if (uri?.scheme !== 'file' || !endings.includes(parse(uri.fsPath).ext)) {
      void vscode.window.showInformationMessage(`Open a file that ends in ${endings.join(' or ')} first.`);
      return undefined;
    }
    for (const document of vscode.workspace.textDocuments) {
      if (document.isDirty && isRead.test(document.uri.fsPath)) await document.save();
    }
    return uri;
  }

  private async traces(target: Target): Promise<void> {
    const file = await this.file(target, ['.e', '.yaml', '.yml']);
    if (file === undefined) return;
    const folder = folderOf(file);
    const name = basename(file.fsPath);
    const words = traceWords(file.fsPath, this.host.traceLimit(file));
    const { document } = await this.host.askWithProgress(`Traces of ${name}`, words, folder);
    this.panels.show('traces', `Traces of ${name}`, (nonce) =>
      isError(document)
        ? messagesPage(name, messagesOf(document), folder, nonce)
        : tracesPage(name, tracesOf(document), nonce),
    );
  }

  private async explain(target: Target): Promise<void> {
    const file = await this.file(target, ['.e', '.yaml', '.yml']);
    if (file === undefined) return;
    const fact = await vscode.window.showInputBox({
      title: 'Explain',
      prompt: 'Why does a fact hold? Leave it empty to learn which axioms contradict each other.',
      placeHolder: 'HoldsAt(On(Lamp),3)',
    });
    if (fact === undefined) return;
    await this.explainTo(basename(file.fsPath), explainWords(file.fsPath, fact), folderOf(file));
  }

  private async explainRun(target: Target): Promise<void> {
    const run = await this.runs.pick(target);
    if (run === undefined) return;
    await this.explainTo(basename(run.fsPath), explainRunWords(run.fsPath, this.host.permission()), folderOf(run));
  }

  private async explainTo(name: string, words: readonly string[], folder: string): Promise<void> {
    const { document } = await this.host.askWithProgress(`Explaining ${name}`, words, folder);
    this.panels.show('explanation', `Explanation of ${name}`, (nonce) =>
      isError(document)
        ? messagesPage(name, messagesOf(document), folder, nonce)
        : explanationPage(name, explanationOf(document), folder, nonce),
    );
  }

  private async run(target: Target): Promise<void> {
    const file = await this.file(target, ['.yaml', '.yml']);
    if (file === undefined) return;
    const folder = folderOf(file);
    const name = freeName(parse(file.fsPath).name, (taken) => existsSync(join(folder, 'out', taken)));
    const out = join(folder, 'out', name);
    const words = runWords(file.fsPath, out, this.host.permission());
    const { document } = await this.host.askWithProgress(`Running ${basename(file.fsPath)}`, words, folder);
    this.runs.refresh();
    if (isError(document)) {
      this.panels.show('explanation', `Run of ${name}`, (nonce) =>
        messagesPage(basename(file.fsPath), messagesOf(document), folder, nonce),
      );
      return;
    }
    const result = runResultOf(document);
    const causes = result.causes.length === 0 ? '' : `: ${result.causes.join('; ')}`;
    const simulations = `${result.simulations} simulation${result.simulations === 1 ? '' : 's'}`;
    void vscode.window.showInformationMessage(
      withoutLinks(`${name}: ${result.verdict} after ${simulations}${causes}`),
    );
    await this.showReport(vscode.Uri.file(out));
  }

  private async report(target: Target): Promise<void> {
    const run = await this.runs.pick(target);
    if (run !== undefined) await this.showReport(run);
  }

  /** Makes the page in a folder of the editor, so that showing a run does not change it. */
  private async showReport(run: vscode.Uri): Promise<void> {
    const key = createHash('sha256').update(run.fsPath).digest('hex').slice(0, 16);
    const page = join(this.storage.fsPath, 'reports', `${key}.html`);
    await mkdir(dirname(page), { recursive: true });
    const name = basename(run.fsPath);
    const folder = folderOf(run);
    const { document } = await this.host.askWithProgress(`Report of ${name}`, reportWords(run.fsPath, page), folder);
    if (isError(document)) {
      this.panels.show('explanation', `Report of ${name}`, (nonce) =>
        messagesPage(name, messagesOf(document), folder, nonce),
      );
      return;
    }
    this.panels.showReport(`Report of ${name}`, await readFile(page, 'utf8'));
  }
}
