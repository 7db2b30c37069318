// A stand-in for the editor's interface, as far as the extension uses it, for tests of what the
// modules do together. It keeps what they registered and showed. Import it before them.

import Module from 'node:module';

import { join, relative } from 'node:path';
import { readdirSync } from 'node:fs';

type Listener<T> = (value: T) => unknown;

class Disposable {
  constructor(private readonly end: () => void = () => {}) {}
  dispose(): void {
    this.end();
  }
}

class EventEmitter<T> {
  private readonly listeners = new Set<Listener<T>>();
  readonly event = (listener: Listener<T>): Disposable => {
    this.listeners.add(listener);
    return new Disposable(() => this.listeners.delete(listener));
  };
  fire(value: T): void {
    for (const listener of this.listeners) listener(value);
  }
}

class Uri {
  private constructor(
    readonly scheme: string,
    readonly fsPath: string,
  ) {}
  static file(path: string): Uri {
    return new Uri('file', path);
  }
  static joinPath(base: Uri, ...parts: string[]): Uri {
    return new Uri(base.scheme, join(base.fsPath, ...parts));
  }
  toString(): string {
    return `${this.scheme}://${this.fsPath}`;
  }
}

class Position {
  constructor(
    readonly line: number,
    readonly character: number,
  ) {}
}

class Range {
  constructor(
    readonly start: Position,
    readonly end: Position,
  ) {}
}

class Location {
  constructor(
    readonly uri: Uri,
    readonly range: Range,
  ) {}
}

class TreeItem {
  resourceUri: Uri | undefined;
  description: string | undefined;
  constructor(readonly label: string) {}
}

class ThemeIcon {
  constructor(readonly id: string) {}
}

class TestMessage {
  location: Location | undefined;
  constructor(readonly message: string) {}
}

class CancellationTokenSource {
  readonly token = { isCancellationRequested: false, onCancellationRequested: () => new Disposable() };
}

export class TestItem {
  readonly children = new TestItems();
  range: Range | undefined;
  error: string | undefined;
  constructor(
    readonly id: string,
    readonly label: string,
    readonly uri: Uri | undefined,
  ) {}
}

class TestItems {
  private items: TestItem[] = [];
  get size(): number {
    return this.items.length;
  }
  replace(items: TestItem[]): void {
    this.items = items;
  }
  forEach(act: (item: TestItem) => void): void {
    this.items.forEach(act);
  }
  find(id: string): TestItem | undefined {
    return this.items.find((item) => item.id === id);
  }
  ids(): string[] {
    return this.items.map((item) => item.id);
  }
}

interface Panel {
  kind: string;
  title: string;
  options: { enableScripts?: boolean; enableCommandUris?: string[]; localResourceRoots?: unknown[] };
  webview: { html: string };
  reveal: () => void;
  onDidDispose: (listener: () => void) => Disposable;
  dispose: () => void;
}

type RunHandler = (request: { include?: TestItem[]; exclude?: TestItem[] }, token: unknown) => Promise<void>;

/** What the editor would show and know; tests set the first part and read the second. */
export const editor = {
  isTrusted: true,
  folder: '',
  settings: new Map<string, unknown>(),
  input: undefined as string | undefined,
  activeFile: undefined as string | undefined,
  yamlExtension: undefined as unknown,

  commands: new Map<string, (...words: unknown[]) => unknown>(),
  panels: [] as Panel[],
  messages: [] as string[],
  log: [] as string[],
  outcomes: [] as { id: string; outcome: string; text: string; line: number | undefined; file: string | undefined }[],
  tests: undefined as
    | { items: TestItems; run: RunHandler; refresh: (token: unknown) => Promise<void> }
    | undefined,
  trees: new Map<string, { getChildren: () => Promise<TreeItem[]> }>(),
  servers: [] as { command: string; words: string[]; folder: string | undefined; isRunning: boolean }[],
  trusted: new EventEmitter<void>(),
  configured: new EventEmitter<{ affectsConfiguration: (name: string) => boolean }>(),
};

function logger() {
  const write = (text: string): void => {
    editor.log.push(text);
  };
  return { info: write, error: write, show: () => {}, dispose: () => {} };
}

function createPanel(kind: string, title: string, _column: unknown, options: Panel['options']): Panel {
  const panel: Panel = {
    kind,
    title,
    options,
    webview: { html: '' },
    reveal: () => {},
    onDidDispose: () => new Disposable(),
    dispose: () => {},
  };
  editor.panels.push(panel);
  return panel;
}

function createTestController() {
  const items = new TestItems();
  let runHandler: RunHandler = async () => {};
  const controller = {
    items,
    refreshHandler: undefined as ((token: unknown) => Promise<void>) | undefined,
    resolveHandler: undefined as unknown,
    createRunProfile: (_name: string, _kind: number, handler: RunHandler) => {
      runHandler = handler;
    },
    createTestItem: (id: string, label: string, uri?: Uri) => new TestItem(id, label, uri),
    createTestRun: () => testRun,
    dispose: () => {},
  };
  editor.tests = {
    items,
    run: (request, token) => runHandler(request, token),
    refresh: async (token) => controller.refreshHandler?.(token),
  };
  return controller;
}

const note =
  (outcome: string) =>
  (item: TestItem, message?: TestMessage | TestMessage[] | number): void => {
    const first = Array.isArray(message) ? message[0] : message;
    const told = first instanceof TestMessage ? first : undefined;
    editor.outcomes.push({
      id: item.id,
      outcome,
      text: told?.message ?? '',
      line: told?.location?.range.start.line,
      file: told?.location?.uri.fsPath,
    });
  };

const testRun = {
  enqueued: () => {},
  started: () => {},
  appendOutput: () => {},
  passed: note('passed'),
  failed: note('failed'),
  errored: note('errored'),
  skipped: note('skipped'),
  end: () => {},
};

function filesBelow(folder: string): string[] {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    return entry.isDirectory() ? filesBelow(path) : [path];
  });
}

const token = new CancellationTokenSource().token;

const vscode = {
  CancellationTokenSource,
  Disposable,
  EventEmitter,
  Location,
  Position,
  ProgressLocation: { Notification: 15 },
  Range,
  TestMessage,
  TestRunProfileKind: { Run: 1 },
  ThemeIcon,
  TreeItem,
  Uri,
  ViewColumn: { One: 1, Beside: -2 },
  commands: {
    registerCommand: (name: string, act: (...words: unknown[]) => unknown) => {
      editor.commands.set(name, act);
      return new Disposable();
    },
  },
  extensions: {
    getExtension: (name: string) =>
      name === 'redhat.vscode-yaml' && editor.yamlExtension !== undefined
        ? { activate: async () => editor.yamlExtension }
        : undefined,
  },
  tests: { createTestController },
  window: {
    get activeTextEditor() {
      return editor.activeFile === undefined ? undefined : { document: { uri: Uri.file(editor.activeFile) } };
    },
    createOutputChannel: logger,
    createWebviewPanel: createPanel,
    registerTreeDataProvider: (name: string, provider: { getChildren: () => Promise<TreeItem[]> }) => {
      editor.trees.set(name, provider);
      return new Disposable();
    },
    showErrorMessage: async (text: string) => {
      editor.messages.push(text);
    },
    showInformationMessage: async (text: string) => {
      editor.messages.push(text);
    },
    showInputBox: async () => editor.input,
    showQuickPick: async (items: unknown[]) => items[0],
    withProgress: (_options: unknown, act: (progress: unknown, stop: unknown) => unknown) => act({}, token),
  },
  workspace: {
    get isTrusted() {
      return editor.isTrusted;
    },
    get workspaceFolders() {
      return [{ uri: Uri.file(editor.folder), name: 'w', index: 0 }];
    },
    textDocuments: [],
    asRelativePath: (path: string | Uri) => relative(editor.folder, typeof path === 'string' ? path : path.fsPath),
    createFileSystemWatcher: () => {
      const never = () => new Disposable();
      return { onDidChange: never, onDidCreate: never, onDidDelete: never, dispose: () => {} };
    },
    findFiles: async (pattern: string) =>
      filesBelow(editor.folder)
        .filter((path) => path.endsWith(pattern.replace('**', '')))
        .map(Uri.file),
    getConfiguration: () => ({
      get: (name: string, fallback: unknown) => editor.settings.get(name) ?? fallback,
    }),
    getWorkspaceFolder: () => ({ uri: Uri.file(editor.folder) }),
    onDidChangeConfiguration: editor.configured.event,
    onDidGrantWorkspaceTrust: editor.trusted.event,
  },
};

class LanguageClient {
  private readonly server: (typeof editor.servers)[number];
  constructor(_id: string, _name: string, server: { command: string; args: string[]; options: { cwd: string } }) {
    this.server = { command: server.command, words: server.args, folder: server.options.cwd, isRunning: false };
  }
  async start(): Promise<void> {
    this.server.isRunning = true;
    editor.servers.push(this.server);
  }
  async dispose(): Promise<void> {
    this.server.isRunning = false;
  }
}

const loader = Module as unknown as { _load: (name: string, ...rest: unknown[]) => unknown };
const load = loader._load;
loader._load = (name, ...rest) => {
  if (name === 'vscode') return vscode;
  if (name === 'vscode-languageclient/node') return { LanguageClient };
  return load(name, ...rest);
};

/** The context that the editor gives to `activate`. */
export function context(storage: string, extension: string) {
  return {
    subscriptions: [] as { dispose: () => unknown }[],
    storageUri: Uri.file(storage),
    globalStorageUri: Uri.file(storage),
    extensionUri: Uri.file(extension),
  };
}
