// The test explorer: cases of `parallax suite`, a file at a time, listed with --collect-only.

import { createHash } from 'node:crypto';
import { join } from 'node:path';
import * as vscode from 'vscode';

import { type CaseFile, type SuiteStart, byFile, labelOf, placeOf, startsFor, stateOf, textOf } from './cases';
import { type CaseResult, type Message, type Place, casesOf, isError, messagesOf, resultsOf } from './documents';
import { Host, folderOf } from './host';
import { collectWords, suiteWords } from './words';

/** The program's code for a folder without cases. */
const noCaseCode = 'E7006';
const quietMs = 500;

export class TestExplorer {
  private readonly controller = vscode.tests.createTestController('parallax.suites', 'Parallax suites');
  private readonly files = new Map<string, CaseFile>();
  private readonly watcher = vscode.workspace.createFileSystemWatcher('**/*.{yaml,yml}');
  private waiting: NodeJS.Timeout | undefined;
  private wasListed = false;

  constructor(
    private readonly host: Host,
    private readonly storage: vscode.Uri,
  ) {
    this.controller.createRunProfile(
      'Run',
      vscode.TestRunProfileKind.Run,
      (request, token) => this.run(request, token),
      true,
    );
    this.controller.refreshHandler = (token) => this.list(token);
    this.controller.resolveHandler = async (item) => {
      if (item === undefined) await this.list(new vscode.CancellationTokenSource().token);
    };
    this.watcher.onDidChange(() => this.listSoon());
    this.watcher.onDidCreate(() => this.listSoon());
    this.watcher.onDidDelete(() => this.listSoon());
  }

  /** Lists again when files have been quiet for a moment; not before anybody asked for a list. */
  private listSoon(): void {
    if (!this.wasListed) return;
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => {
      void this.list(new vscode.CancellationTokenSource().token);
    }, quietMs);
  }

  /** Asks for the cases of all folders. Where that fails, the earlier list stays, and says so. */
  async list(token: vscode.CancellationToken): Promise<void> {
    if (!vscode.workspace.isTrusted) return;
    this.wasListed = true;
    const found: CaseFile[] = [];
    const problems: vscode.TestItem[] = [];
    for (const folder of vscode.workspace.workspaceFolders ?? []) {
      if (folder.uri.scheme !== 'file') continue;
      const path = folder.uri.fsPath;
      try {
        const { document } = await this.host.ask(collectWords(path), path, token);
        const messages = messagesOf(document);
        if (!isErrorOfList(document)) {
          found.push(...byFile(casesOf(document)));
        } else if (!messages.some((message) => message.code === noCaseCode)) {
          found.push(...[...this.files.values()].filter((file) => file.file.startsWith(`${path}/`)));
          problems.push(...messages.map((message, at) => this.problemItem(message, `${path}#${at}`)));
        }
      } catch (error) {
        this.host.log.error(String(error));
        const item = this.controller.createTestItem(`${path}#0`, 'Suites could not be listed');
        item.error = error instanceof Error ? error.message : String(error);
        problems.push(item);
      }
    }
    if (token.isCancellationRequested) return;
    this.files.clear();
    for (const file of found) this.files.set(file.file, file);
    this.controller.items.replace([...problems, ...found.map((file) => this.fileItem(file))]);
  }

  private problemItem(message: Message, id: string): vscode.TestItem {
    const uri = message.place === undefined ? undefined : vscode.Uri.file(message.place.file);
    const item = this.controller.createTestItem(id, 'Suites could not be listed', uri);
    if (message.place !== undefined) item.range = rangeAt(message.place.line, message.place.column);
    item.error = [`${message.code}: ${message.message}`, ...message.notes, message.help].join('\n').trim();
    return item;
  }

  private fileItem(file: CaseFile): vscode.TestItem {
    const uri = vscode.Uri.file(file.file);
    const item = this.controller.createTestItem(file.file, vscode.workspace.asRelativePath(uri), uri);
    item.range = rangeAt(file.line, 1);
    item.children.replace(
      file.cases.map((one) => {
        const child = this.controller.createTestItem(one.name, labelOf(one), uri);
        child.range = rangeAt(one.line, 1);
        return child;
      }),
    );
    return item;
  }

  private async run(request: vscode.TestRunRequest, token: vscode.CancellationToken): Promise<void> {
    const run = this.controller.createTestRun(request);
    try {
      const tests = this.wanted(request);
      for (const test of tests.values()) run.enqueued(test);
      const wanted = new Set(tests.keys());
      for (const file of this.files.values()) {
        for (const start of startsFor(file, wanted)) {
          if (token.isCancellationRequested) return;
          await this.runStart(start, tests, run, token);
        }
      }
    } finally {
      run.end();
    }
  }

  /** The tests without children that the request includes, by the names of their cases. */
  private wanted(request: vscode.TestRunRequest): Map<string, vscode.TestItem> {
    const tests = new Map<string, vscode.TestItem>();
    const excluded = new Set(request.exclude ?? []);
    const add = (item: vscode.TestItem): void => {
      if (excluded.has(item)) return;
      if (item.children.size > 0) {
        item.children.forEach(add);
      } else if (item.error === undefined) {
        tests.set(item.id, item);
      }
    };
    if (request.include === undefined) {
      this.controller.items.forEach(add);
    } else {
      request.include.forEach(add);
    }
    return tests;
  }

  private async runStart(
    start: SuiteStart,
    tests: ReadonlyMap<string, vscode.TestItem>,
    run: vscode.TestRun,
    token: vscode.CancellationToken,
  ): Promise<void> {
    const items = start.names.flatMap((name) => tests.get(name) ?? []);
    for (const item of items) run.started(item);
    const folder = folderOf(vscode.Uri.file(start.path));
    // A folder of the editor's own: results of suites at a terminal stay as they are.
    const key = createHash('sha256').update(start.path).digest('hex').slice(0, 16);
    const out = join(this.storage.fsPath, 'suites', key);
    const words = suiteWords(start.path, start.only, out, this.host.permission());
    try {
      const { document, remarks } = await this.host.ask(words, folder, token);
      run.appendOutput(remarks.replace(/\r?\n/g, '\r\n'));
      if (isErrorOfList(document)) {
        for (const item of items) run.errored(item, messagesOf(document).map(testMessage));
        return;
      }
      const results = new Map(resultsOf(document).map((result) => [result.name, result]));
      for (const item of items) tell(run, item, results.get(item.id), remarks);
    } catch (error) {
      const text = error instanceof Error ? error.message : String(error);
      for (const item of items) run.errored(item, new vscode.TestMessage(text));
    }
  }

  dispose(): void {
    clearTimeout(this.waiting);
    this.watcher.dispose();
    this.controller.dispose();
  }
}

/** Documents of suites have `cases`; an error has messages alone. */
function isErrorOfList(document: Record<string, unknown>): boolean {
  return isError(document) && document['cases'] === undefined;
}

function rangeAt(line: number, column: number): vscode.Range {
  const at = new vscode.Position(Math.max(0, line - 1), Math.max(0, column - 1));
  return new vscode.Range(at, at);
}

function locationOf(place: Place): vscode.Location {
  return new vscode.Location(vscode.Uri.file(place.file), rangeAt(place.line, place.column));
}

function testMessage(message: Message): vscode.TestMessage {
  const out = new vscode.TestMessage([`${message.code}: ${message.message}`, ...message.notes].join('\n'));
  if (message.place !== undefined) out.location = locationOf(message.place);
  return out;
}

function tell(run: vscode.TestRun, item: vscode.TestItem, result: CaseResult | undefined, remarks: string): void {
  if (result === undefined) {
    run.errored(item, new vscode.TestMessage('The suite has no such case any more. Refresh the tests.'));
    return;
  }
  const took = result.wallS * 1000;
  const state = stateOf(result);
  if (state === 'passed') {
    run.passed(item, took);
    return;
  }
  const message = new vscode.TestMessage(textOf(result));
  const place = placeOf(result.problems, remarks);
  if (place !== undefined) {
    message.location = locationOf(place);
  } else if (item.uri !== undefined && item.range !== undefined) {
    message.location = new vscode.Location(item.uri, item.range);
  }
  if (state === 'skipped') {
    run.appendOutput(`${textOf(result)}\r\n`.replace(/\r?\n/g, '\r\n'), message.location, item);
    run.skipped(item);
  } else if (state === 'failed') {
    run.failed(item, message, took);
  } else {
    run.errored(item, message, took);
  }
}
