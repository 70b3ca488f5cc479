"""The intents of a conversation: what got lost is noticed, named, and put back if it fits."""

from aidl_lang.tools.llm.intent.inventory import Kind
from aidl_lang.tools.llm.intent.ledger import Ledger, Loss, Restored, request

__all__ = ["Kind", "Ledger", "Loss", "Restored", "request"]
