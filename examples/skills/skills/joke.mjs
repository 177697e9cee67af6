// A joke from the web service of $JOKE_URL, which answers {"joke": "…"}. Calls come and answers go as lines of JSON.
import { createInterface } from 'node:readline';

const answer = message => console.log(JSON.stringify(message));
let giveUp = new AbortController();

for await (const line of createInterface({ input: process.stdin })) {
  const { call, arguments: given, cancel } = JSON.parse(line);
  if (cancel) giveUp.abort();
  if (given) tell(call, given.topic);
}

async function tell(call, topic) {
  giveUp = new AbortController();
  const late = setTimeout(() => giveUp.abort(new Error('the service took more than 3 s')), 3000);
  try {
    const url = `${process.env.JOKE_URL}?topic=${encodeURIComponent(topic)}`;
    const found = await fetch(url, { signal: giveUp.signal });
    answer({ call, result: { text: (await found.json()).joke } });
  } catch (error) {
    answer({ call, error: `no joke: ${error.cause?.message ?? error.message}` });
  }
  clearTimeout(late);
}
