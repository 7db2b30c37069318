// Pages of the side panel, as texts. They have no scripts and load nothing: the policy admits one
// style, by a nonce. Links are of one kind, to a place in a file, and go through one command.

import { isAbsolute, join } from 'node:path';

import type {
  Axiom,
  Contradictions,
  Difference,
  Message,
  Place,
  Reasons,
  Timepoint,
  Trace,
  Traces,
} from './documents';

/** The only command that a link of these pages can call. */
export const openPlaceCommand = 'parallax.openPlace';

const style = `
:root { color-scheme: light dark; }
:root:has(body.vscode-light) { color-scheme: light; }
:root:has(body.vscode-dark) { color-scheme: dark; }
body {
  --text: var(--vscode-editor-foreground, #1f2328);
  --ground: var(--vscode-editor-background, #ffffff);
  --quiet: var(--vscode-descriptionForeground, #59636e);
  --line: var(--vscode-panel-border, #d0d7de);
  --link: var(--vscode-textLink-foreground, #0757ba);
  --more: #1a6e2e;
  --less: #b42318;
  color: var(--text); background: var(--ground); margin: 0; padding: 0.75rem 1rem 2rem;
  font: var(--vscode-font-weight, 400) var(--vscode-font-size, 13px)/1.5
    var(--vscode-font-family, system-ui, sans-serif);
}
@media (prefers-color-scheme: dark) {
  body {
    --text: var(--vscode-editor-foreground, #d4d4d4);
    --ground: var(--vscode-editor-background, #1f1f1f);
    --quiet: var(--vscode-descriptionForeground, #9d9d9d);
    --line: var(--vscode-panel-border, #3c3c3c);
    --link: var(--vscode-textLink-foreground, #6cb6ff);
    --more: #73c991;
    --less: #f4877e;
  }
}
body.vscode-light { --more: #1a6e2e; --less: #b42318; }
body.vscode-dark { --more: #73c991; --less: #f4877e; }
body.vscode-high-contrast { --more: var(--text); --less: var(--text); }
h1 { font-size: 1.25rem; font-weight: 600; margin: 0 0 0.25rem; overflow-wrap: anywhere; }
h2 { font-size: 1rem; font-weight: 600; margin: 1.25rem 0 0.25rem; }
p { margin: 0.25rem 0 0.5rem; max-width: 72ch; overflow-wrap: anywhere; }
.quiet { color: var(--quiet); }
code, .atom { font-family: var(--vscode-editor-font-family, ui-monospace, monospace); font-size: 0.95em; }
code { overflow-wrap: anywhere; white-space: pre-wrap; color: inherit; background: none; padding: 0; }
.atom { display: inline-block; margin-right: 0.75em; overflow-wrap: anywhere; }
a { color: var(--link); }
details { border-top: 1px solid var(--line); padding: 0.25rem 0; }
summary { cursor: pointer; padding: 0.25rem 0; }
:focus-visible { outline: 2px solid var(--vscode-focusBorder, var(--link)); outline-offset: 1px; }
table { border-collapse: collapse; width: 100%; margin: 0.25rem 0 0.75rem; }
th, td { text-align: left; vertical-align: top; padding: 0.25rem 0.75rem 0.25rem 0; border-top: 1px solid var(--line); }
thead th { color: var(--quiet); font-weight: 600; border-top: 0; }
tbody th { font-weight: 600; font-variant-numeric: tabular-nums; }
.more { color: var(--more); }
.less { color: var(--less); }
ins, del { text-decoration: none; }
ol { margin: 0.25rem 0; padding-left: 2em; }
li { margin: 0.35rem 0; }
li details { border: 0; padding: 0; }
@media (max-width: 30rem) {
  thead { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
  tr { display: block; border-top: 1px solid var(--line); padding: 0.25rem 0; }
  th, td { display: block; border: 0; padding: 0; }
  td:empty { display: none; }
  td::before { content: attr(data-head) ' '; color: var(--quiet); }
  tbody th::before { content: 'time '; color: var(--quiet); font-weight: 400; }
}
`;

const entities: Record<string, string> = {
  '&': '&amp;',
  '<': '&lt;',
  '>': '&gt;',
  '"': '&quot;',
  "'": '&#39;',
};

export function escaped(text: string): string {
  return text.replace(/[&<>"']/g, (character) => entities[character] ?? character);
}

/** Sentences of the program, in which names stand between backticks. */
function prose(text: string): string {
  return escaped(text).replace(/`([^`]+)`/g, '<code>$1</code>');
}

/** A text for a notification, where the editor would make links, also to commands, of `[a](b)`. */
export function withoutLinks(text: string): string {
  return text.replaceAll('](', '] (');
}

/** A whole page. `body` is HTML; the title is text. */
function page(title: string, body: string, nonce: string): string {
  const policy = `default-src 'none'; style-src 'nonce-${nonce}'; base-uri 'none'; form-action 'none'`;
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${escaped(title)}</title>
<style nonce="${nonce}">${style}</style>
</head>
<body>
<h1>${escaped(title)}</h1>
${body}
</body>
</html>
`;
}

/** A link that opens the place; names of files start at the folder in which the program ran. */
function placeLink(place: Place, folder: string): string {
  const file = isAbsolute(place.file) ? place.file : join(folder, place.file);
  const target = encodeURIComponent(JSON.stringify([file, place.line, place.column]));
  const inside = folder !== '' && file.startsWith(`${folder}/`);
  const shown = `${inside ? file.slice(folder.length + 1) : file}:${place.line}`;
  return `<a href="command:${openPlaceCommand}?${target}">${escaped(shown)}</a>`;
}

function atoms(list: readonly string[]): string {
  return list.map((atom) => `<span class="atom">${escaped(atom)}</span>`).join(' ');
}

/** The fluents that begin to hold (`+`) and cease to (`−`) from one timepoint to the next. */
export function changes(before: Timepoint | undefined, now: Timepoint): { begins: string[]; ends: string[] } {
  if (before === undefined) return { begins: [], ends: [] };
  const old = new Set(before.holds);
  const current = new Set(now.holds);
  return {
    begins: now.holds.filter((fluent) => !old.has(fluent)),
    ends: before.holds.filter((fluent) => !current.has(fluent)),
  };
}

function timepointRow(before: Timepoint | undefined, now: Timepoint, hasReleased: boolean): string {
  const { begins, ends } = changes(before, now);
  const changed = [
    ...begins.map((fluent) => `<ins class="atom more">+${escaped(fluent)}</ins>`),
    ...ends.map((fluent) => `<del class="atom less">−${escaped(fluent)}</del>`),
  ].join(' ');
  const cells = [
    ['happens', atoms(now.happens)],
    ['changes', changed],
    ['holds', atoms(now.holds)],
  ];
  if (hasReleased) cells.push(['released', atoms(now.released)]);
  const written = cells.map(([head, cell]) => `<td data-head="${head}">${cell}</td>`).join('');
  return `<tr><th scope="row">${now.time}</th>${written}</tr>`;
}

function traceSection(trace: Trace, isOpen: boolean): string {
  const hasReleased = trace.timepoints.some((point) => point.released.length > 0);
  const rows = trace.timepoints.map((point, at) =>
    timepointRow(trace.timepoints[at - 1], point, hasReleased),
  );
  const events = trace.timepoints.flatMap((point) => point.happens);
  const heads = ['Time', 'Happens', 'Changes', 'Holds', ...(hasReleased ? ['Released'] : [])];
  const end = trace.ended === '' ? '' : `<p class="quiet">The plan ended: ${escaped(trace.ended)}</p>`;
  const predicates =
    trace.predicates.length === 0
      ? ''
      : `<p><span class="quiet">Predicates:</span> ${atoms(trace.predicates)}</p>`;
  return `<details${isOpen ? ' open' : ''}>
<summary>Trace ${trace.number} <span class="quiet">${escaped(events.join(', ') || 'no event')}</span></summary>
<table><thead><tr>${heads.map((head) => `<th scope="col">${head}</th>`).join('')}</tr></thead>
<tbody>${rows.join('\n')}</tbody></table>${predicates}${end}
</details>`;
}

export function tracesPage(name: string, traces: Traces, nonce: string): string {
  const count = traces.list.length;
  let head = traces.isComplete ? `${counted(count, 'trace')}, and no others.` : `The first ${counted(count, 'trace')}.`;
  if (count === 0) {
    head = traces.isComplete
      ? 'There is no trace: nothing satisfies all axioms. “Parallax: Explain” says which contradict.'
      : 'No trace was found before the search was stopped.';
  }
  const sections = traces.list.map((trace, at) => traceSection(trace, at === 0));
  return page(`Traces of ${name}`, `<p class="quiet">${head}</p>\n${sections.join('\n')}`, nonce);
}

function counted(count: number, noun: string): string {
  return `${count} ${noun}${count === 1 ? '' : 's'}`;
}

function axiomItem(axiom: Axiom, folder: string): string {
  const instances =
    axiom.instances.length === 0
      ? ''
      : `<details><summary class="quiet">${counted(axiom.instances.length, 'instance')}</summary>${axiom.instances
          .map((instance) => `<p><code>${escaped(instance)}</code></p>`)
          .join('')}</details>`;
  return `<li>${placeLink(axiom.place, folder)} <span class="quiet">${escaped(axiom.what)}</span><br>
<code>${escaped(axiom.text)}</code>${instances}</li>`;
}

function differenceRow(one: Difference): string {
  const value = (holds: boolean): string => (holds ? 'holds' : 'does not hold');
  return `<tr><th scope="row">${one.timepoint}</th><td data-head="fluent">${atoms([one.fluent])}</td>
<td data-head="model">${value(one.predicted)}</td><td data-head="world">${value(one.observed)}</td></tr>`;
}

function contradictionsBody(found: Contradictions, folder: string): string {
  if (found.sets.length === 0) return '<p>Nothing contradicts: the axioms have a common trace.</p>';
  const differences =
    found.differences.length === 0
      ? ''
      : `<h2>What differs</h2><table><thead><tr><th scope="col">Time</th><th scope="col">Fluent</th>
<th scope="col">Model</th><th scope="col">World</th></tr></thead>
<tbody>${found.differences.map(differenceRow).join('')}</tbody></table>`;
  const cause = found.cause === '' ? '' : `<h2>Cause</h2><p>${prose(found.cause)}</p>`;
  const sets = found.sets.map((set, at) => {
    const what = found.differences.length === 0 ? 'contradict each other' : 'the run contradicts';
    const title = `Axioms that ${what}${found.sets.length === 1 ? '' : `, set ${at + 1}`}`;
    const words = set.words === '' ? '' : `<p>${prose(set.words)}</p>`;
    const items = set.axioms.map((axiom) => axiomItem(axiom, folder)).join('\n');
    return `<h2>${title}</h2>${words}<ol>${items}</ol>`;
  });
  const more = found.isComplete ? '' : '<p class="quiet">There may be further sets.</p>';
  return `${differences}${cause}${sets.join('\n')}${more}`;
}

function reasonsBody(reasons: Reasons, folder: string): string {
  const steps = reasons.steps.map((step) => {
    const because = [
      ...step.premises.map((fact) => `<span class="atom">${escaped(fact)}</span>`),
      ...step.absent.map((fact) => `<span class="atom">${escaped(fact)}</span>`),
    ].join(' ');
    const from = because === '' ? '' : `<br><span class="quiet">from</span> ${because}`;
    const axiom =
      step.axiom === undefined
        ? ''
        : `<br>${placeLink(step.axiom.place, folder)} <code>${escaped(step.axiom.text)}</code>`;
    return `<li><span class="atom">${escaped(step.fact)}</span> <span class="quiet">${escaped(step.why)}</span>${from}${axiom}</li>`;
  });
  return `<p><code>${escaped(reasons.fact)}</code> in trace ${reasons.trace}</p><ol>${steps.join('\n')}</ol>`;
}

/** `folder` is where the program ran; paths below it are shown without it. */
export function explanationPage(
  name: string,
  explanation: Contradictions | Reasons,
  folder: string,
  nonce: string,
): string {
  const body =
    explanation.kind === 'reasons'
      ? reasonsBody(explanation, folder)
      : contradictionsBody(explanation, folder);
  return page(`Explanation of ${name}`, body, nonce);
}

/** A page for messages instead of an answer. */
export function messagesPage(name: string, messages: readonly Message[], folder: string, nonce: string): string {
  const items = messages.map((one) => {
    const place = one.place === undefined ? '' : `${placeLink(one.place, folder)}: `;
    const further = [...one.notes, one.help]
      .filter((text) => text !== '')
      .map((text) => `<br><span class="quiet">${prose(text)}</span>`)
      .join('');
    return `<li>${place}${escaped(one.severity)}[${escaped(one.code)}]: ${prose(one.message)}${further}</li>`;
  });
  return page(`No answer about ${name}`, `<ol>${items.join('\n')}</ol>`, nonce);
}

/**
 * May the page of `parallax report` be shown? Its policy must stand before anything that it would
 * govern, forbid what it does not name, and name hashes alone.
 */
export function hasStrictPolicy(html: string): boolean {
  const found = /<meta http-equiv="Content-Security-Policy" content="([^"]*)">/.exec(html);
  if (found === null) return false;
  if (/<(script|style|link|img|iframe|object|base)\b/i.test(html.slice(0, found.index))) return false;
  const directives = (found[1] ?? '').split(';').map((directive) => directive.trim().split(/\s+/));
  const isClosed = directives.some(([name, ...sources]) => name === 'default-src' && sources.join() === "'none'");
  const areHashes = directives.every(([, ...sources]) =>
    sources.every((source) => source === "'none'" || /^'sha256-[A-Za-z0-9+/=]+'$/.test(source)),
  );
  return isClosed && areHashes;
}
