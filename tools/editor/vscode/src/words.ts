// The words of each command. Files are named by absolute paths, and texts of users stand behind
// `=`, so that neither can be taken for an option.

/** Whether simulators that scenarios name as commands may be started: parallax.allowCommands. */
export interface Permission {
  allowCommands: boolean;
}

export function serverWords(): string[] {
  return ['lsp'];
}

export function traceWords(file: string, limit: number): string[] {
  return ['traces', file, '--json', '--limit', String(limit)];
}

/** Why a fact holds; without one, which axioms contradict each other. */
export function explainWords(file: string, fact: string): string[] {
  const words = ['explain', file, '--json'];
  if (fact.trim() !== '') words.push(`--why=${fact.trim()}`);
  return words;
}

export function explainRunWords(folder: string, permission: Permission): string[] {
  const words = ['explain', folder, '--json'];
  if (permission.allowCommands) words.push('--allow-commands');
  return words;
}

/** `run` starts a scenario's command by default, unlike other commands, so both are said. */
export function runWords(scenario: string, out: string, permission: Permission): string[] {
  const commands = permission.allowCommands ? '--allow-commands' : '--no-commands';
  return ['run', scenario, '--json', '--out', out, commands];
}

export function reportWords(folder: string, page: string): string[] {
  return ['report', folder, '--json', '-o', page];
}

export function collectWords(path: string): string[] {
  return ['suite', path, '--json', '--collect-only'];
}

/** The cases of a file whose names contain `only`; without it, all cases below the path. */
export function suiteWords(
  path: string,
  only: string | undefined,
  out: string,
  permission: Permission,
): string[] {
  const words = ['suite', path, '--json', '--out', out];
  if (only !== undefined) words.push(`--only=${only}`);
  if (permission.allowCommands) words.push('--allow-commands');
  return words;
}

/** The first of `out/NAME`, `out/NAME-2`, ... that is free. */
export function freeName(stem: string, isTaken: (name: string) => boolean): string {
  if (!isTaken(stem)) return stem;
  let number = 2;
  while (isTaken(`${stem}-${number}`)) number += 1;
  return `${stem}-${number}`;
}
